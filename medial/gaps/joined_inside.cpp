#include "joined_inside.h"

#include <algorithm>
#include <unordered_set>

namespace orchard::detail {
namespace {

bool segment_touches(const Sphere& ball, const Point& a, const Point& b) {
  const Vector along = b - a;
  const double squared = along.squaredNorm();
  const double fraction = squared > 0 ? std::clamp((ball.center - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (a + fraction * along - ball.center).squaredNorm() <= ball.radius * ball.radius;
}

}  // namespace

bool joined_inside(const Surface& surface, const SurfaceSampling& sampling, const Sphere& ball,
                   std::span<const Index> from, std::array<Index, 2> points) {
  std::array<std::vector<Index>, 2> goals;
  for (unsigned k = 0; k < 2; ++k) {
    surface.triangles_at(sampling.triangles[points[k]], sampling.features[points[k]], goals[k]);
  }
  std::array<bool, 2> reached{false, false};
  std::vector<Index> open(from.begin(), from.end());
  // A hash set is safe here: the order of its entries is never used.
  std::unordered_set<Index> met(from.begin(), from.end());
  while (!open.empty()) {
    const Index triangle = open.back();
    open.pop_back();
    for (unsigned k = 0; k < 2; ++k) {
      reached[k] = reached[k] || std::find(goals[k].begin(), goals[k].end(), triangle) != goals[k].end();
    }
    if (reached[0] && reached[1]) return true;
    const std::array<Point, 3> corners = surface.corners(triangle);
    for (unsigned edge = 0; edge < 3; ++edge) {
      const Index next = surface.neighbors(triangle)[edge];
      if (next == kNone || met.contains(next)) continue;
      if (!segment_touches(ball, corners[edge], corners[(edge + 1) % 3])) continue;
      met.insert(next);
      open.push_back(next);
    }
  }
  return false;
}

}  // namespace orchard::detail
