#include "orchard/spheretree/measure.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

// The tighter of the bound by the centre's distance and the searched one. The latter is widened a little: a proof of a
// bound without room to spare takes far longer than finding it did.
double bound_over_ball(const Surface& surface, const Sphere& ball, double center_distance, double at_least) {
  constexpr double kRoom = 0.25;  // of the search's tolerance
  const DistanceTolerance tolerance;
  const Bounds found = farthest_from_solid(surface, ball, tolerance, at_least);
  const double width = std::max(tolerance.of_radius * surface.bounding_radius(), tolerance.of_distance * found.lower);
  return std::min(distance_bound(center_distance, ball.radius), found.upper + kRoom * width);
}

void measure_node(SphereNode& node, const Surface& surface) {
  const Sphere& ball = node.sphere;
  if (!surface.solid()) {
    node.center_distance = surface.distance(ball.center);
    node.distance_bound = distance_bound(node.center_distance, ball.radius);
    node.inaccuracy = node.distance_bound;
    return;
  }
  node.center_distance = surface.signed_distance(ball.center);
  const Bounds on_sphere = inaccuracy(surface, ball, {tolerance::kInaccuracy, 0});
  node.inaccuracy = on_sphere.upper;
  node.distance_bound = bound_over_ball(surface, ball, node.center_distance, on_sphere.lower);
}

}  // namespace

void measure(SphereTree& tree, const Surface& surface, const Progress& progress) {
  const std::size_t count = tree.nodes.size(), slice = std::max<std::size_t>(32, count / 50 + 1);
  for (std::size_t begin = 0; begin < count; begin += slice) {
    report_progress(progress, "measuring", static_cast<double>(begin) / static_cast<double>(count));
    tbb::parallel_for(begin, std::min(count, begin + slice),
                      [&](std::size_t i) { measure_node(tree.nodes[i], surface); });
  }
}

}  // namespace orchard
