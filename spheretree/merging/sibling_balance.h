#pragma once
#include <algorithm>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The children of one node.
struct Family {
  Index spheres = 0;
  double cost = 0;  // sum of the spheres' costs
};

// The most spheres that a family may have, if families of a level have `branching` on average. A large part of the
// model that a single sphere of the first level holds needs a large share of the spheres at every level below. With a
// limit of twice `branching`, the largest ball of the lamp's third level had .05 to .09 R, depending on how the first
// level happened to be divided; with three times it has .05 R, and four times gains nothing.
inline Index max_children(Index branching) { return std::min<Index>(64, 3 * branching); }

// Shares the spheres that all families have now out among the families again. The model is that a family's cost falls
// with a power of its number of spheres; the next sphere always goes to the family where it saves most. Each family
// gets two to max_children(); an empty one gets none.
std::vector<Index> balanced_counts(const std::vector<Family>& families, double power, Index branching);

}  // namespace orchard::detail
