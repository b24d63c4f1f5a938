#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// Fills center_distance, distance_bound and inaccuracy of every node, in mesh units. If the surface is not solid,
// distances are unsigned and the inaccuracy is the distance bound. Parallel over nodes; the result does not depend on
// the thread count. Source: dissertation 5.3.5 and 6.3.4.
void measure(SphereTree& tree, const Surface& surface, const Progress& progress = {});

// Fills the inaccuracy alone, with the same numbers, in about half the time: for trees that are only compared with.
// `known`: a tree of the same surface that is measured; where it has the same sphere, its number is taken.
void measure_inaccuracy(SphereTree& tree, const Surface& surface, const Progress& progress = {},
                        const SphereTree& known = {});

}  // namespace orchard
