#include "orchard/spheretree/measure.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <vector>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

// Returns the smaller of two bounds: the one from the distance of the centre, and the one from a search over the ball.
// The second is enlarged a little, because verify() would need far more time to prove it without this margin than the
// search needed to find it.
double bound_over_ball(const Surface& surface, const Sphere& ball, double center_distance, double at_least) {
  constexpr double kRoom = 0.25;  // the margin, as a fraction of the search's tolerance
  const DistanceTolerance tolerance;
  const Bounds found = farthest_from_solid(surface, ball, tolerance, at_least);
  const double width = std::max(tolerance.of_radius * surface.bounding_radius(), tolerance.of_distance * found.lower);
  return std::min(distance_bound(center_distance, ball.radius), found.upper + kRoom * width);
}

// Returns both bounds on the inaccuracy. The lower one shortens the search over the ball.
Bounds inaccuracy_of(const SphereNode& node, const Surface& surface) {
  if (surface.solid()) return inaccuracy(surface, node.sphere, {tolerance::kInaccuracy, 0});
  const double bound = distance_bound(surface.distance(node.sphere.center), node.sphere.radius);
  return {bound, bound};
}

void measure_node(SphereNode& node, const Surface& surface) {
  const Sphere& ball = node.sphere;
  const Bounds on_sphere = inaccuracy_of(node, surface);
  node.inaccuracy = on_sphere.upper;
  if (!surface.solid()) {
    node.center_distance = surface.distance(ball.center);
    node.distance_bound = on_sphere.upper;
    return;
  }
  node.center_distance = surface.signed_distance(ball.center);
  node.distance_bound = bound_over_ball(surface, ball, node.center_distance, on_sphere.lower);
}

bool by_sphere(const SphereNode& a, const SphereNode& b) {
  const auto numbers = [](const Sphere& s) { return std::array{s.center.x(), s.center.y(), s.center.z(), s.radius}; };
  return numbers(a.sphere) < numbers(b.sphere);
}

template <class MeasureNode>
void for_each_node(SphereTree& tree, const Progress& progress, MeasureNode&& measure_one) {
  const std::size_t count = tree.nodes.size(), slice = std::max<std::size_t>(32, count / 50 + 1);
  for (std::size_t begin = 0; begin < count; begin += slice) {
    report_progress(progress, "measuring", static_cast<double>(begin) / static_cast<double>(count));
    tbb::parallel_for(begin, std::min(count, begin + slice), [&](std::size_t i) { measure_one(tree.nodes[i]); });
  }
}

}  // namespace

void measure(SphereTree& tree, const Surface& surface, const Progress& progress) {
  for_each_node(tree, progress, [&](SphereNode& node) { measure_node(node, surface); });
}

void measure_inaccuracy(SphereTree& tree, const Surface& surface, const Progress& progress, const SphereTree& known) {
  std::vector<SphereNode> sorted = known.nodes;
  std::sort(sorted.begin(), sorted.end(), by_sphere);
  for_each_node(tree, progress, [&](SphereNode& node) {
    const auto same = std::lower_bound(sorted.begin(), sorted.end(), node, by_sphere);
    const bool measured = same != sorted.end() && !by_sphere(node, *same);
    node.inaccuracy = measured ? same->inaccuracy : inaccuracy_of(node, surface).upper;
  });
}

}  // namespace orchard
