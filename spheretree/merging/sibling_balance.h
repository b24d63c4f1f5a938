#pragma once
#include <algorithm>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The children of one node.
struct Family {
  Index spheres = 0;
  double cost = 0;  // their sum
};

// How many spheres a family may have, where a level has `branching` of them for each on average. A part of the model
// that one sphere of the first level holds alone needs a large share at every level below: with twice `branching` the
// largest ball of the lamp's third level was .05 to .09 R, as the first level happened to be cut; with three times it
// is .05, and four times gains nothing.
inline Index max_children(Index branching) { return std::min<Index>(64, 3 * branching); }

// How many spheres each family should have, as many as all have now. A family's cost falls with their number as a
// power of it; the next sphere goes where it saves most. Two to max_children() each; none where there is none.
std::vector<Index> balanced_counts(const std::vector<Family>& families, double power, Index branching);

}  // namespace orchard::detail
