#include "one_sided.h"

#include <cmath>
#include <cstdint>
#include <vector>

namespace orchard::detail {

bool one_sided(const Surface& surface) {
  if (!surface.self_intersections().empty()) return false;
  std::vector<std::uint8_t> seen(surface.mesh().triangles.size(), 0);
  std::vector<Index> stack;
  for (Index start = 0; start < seen.size(); ++start) {
    if (seen[start]) continue;
    // Take a place straight out of the component's first face, so near that this face is the nearest one to it.
    const auto [a, b, c] = surface.corners(start);
    double step = std::sqrt(surface.area(start));
    Point outside = (a + b + c) / 3;
    const Point middle = outside;
    ClosestPoint nearest;
    do {
      step *= 0.5;
      outside = middle + step * surface.normal(start);
      nearest = surface.closest(outside);
    } while (nearest.triangle != start && step > 0);
    if (!(step > 0) || surface.winding_number(outside) != 0) return false;
    seen[start] = 1;
    stack.push_back(start);
    while (!stack.empty()) {
      const Index triangle = stack.back();
      stack.pop_back();
      for (const Index other : surface.neighbors(triangle)) {
        if (other != kNone && !seen[other]) seen[other] = 1, stack.push_back(other);
      }
    }
  }
  return true;
}

}  // namespace orchard::detail
