#include "orchard/spheretree/measure.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

void measure_node(SphereNode& node, const Surface& surface) {
  const Sphere& ball = node.sphere;
  if (!surface.solid()) {
    node.center_distance = surface.distance(ball.center);
    node.distance_bound = distance_bound(node.center_distance, ball.radius);
    node.inaccuracy = node.distance_bound;
    return;
  }
  node.center_distance = surface.signed_distance(ball.center);
  node.distance_bound = distance_bound(node.center_distance, ball.radius);
  node.inaccuracy = inaccuracy(surface, ball, tolerance::kInaccuracy).upper;
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
