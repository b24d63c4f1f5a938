#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The children of one node.
struct Family {
  Index spheres = 0;
  double cost = 0;  // their sum
};

// How many spheres each family should have, as many as all have now. A family's cost falls with their number as a
// power of it; the next sphere goes where it saves most. Two to twice `branching` each, at most 64; none where there is
// none.
std::vector<Index> balanced_counts(const std::vector<Family>& families, double power, Index branching);

}  // namespace orchard::detail
