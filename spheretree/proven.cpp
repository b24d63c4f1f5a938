#include "orchard/spheretree/proven.h"

#include <algorithm>
#include <cmath>

#include "orchard/covering/inaccuracy.h"

namespace orchard {
namespace {

// Raises a bound by the amount that verify() found missing, and by more than the rounding of the packed bound to float.
double raised(double bound, double amount, double bounding_radius) {
  return bound + amount + 0x1p-22 * (std::abs(bound) + amount + bounding_radius);
}

void weaken(SphereNode& node, const Violation& violation, double bounding_radius) {
  if (violation.kind == Violation::Kind::center_distance) {
    node.center_distance = raised(node.center_distance, violation.amount, bounding_radius);
  } else {
    node.distance_bound = std::max(raised(std::max(0.0, node.distance_bound), violation.amount, bounding_radius),
                                   distance_bound(node.center_distance, node.sphere.radius));
  }
}

}  // namespace

ProvenTree pack_proven(SphereTree& tree, const Surface& surface, const Progress& progress) {
  ProvenTree result;
  const auto prove = [&] {
    result.packed = pack(tree, surface);
    result.proof = verify(surface, result.packed, {.max_violations = kNone}, progress);
  };
  prove();
  if (result.proof.bounds_violated == 0) return result;
  for (const Violation& violation :
       result.proof.violations) {  // the one of a node's centre comes before its other ones
    if (violation.kind != Violation::Kind::center_distance && violation.kind != Violation::Kind::distance_bound)
      continue;
    weaken(tree.nodes[violation.node], violation, surface.bounding_radius());
    if (result.weakened.empty() || result.weakened.back() != violation.node) result.weakened.push_back(violation.node);
  }
  prove();
  return result;
}

}  // namespace orchard
