#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// Fills center_distance, distance_bound and inaccuracy of every node (dissertation 5.3.5, 6.3.4). Parallel over nodes.
// If the surface is not solid, distances are unsigned and the inaccuracy is the distance bound.
void measure(SphereTree& tree, const Surface& surface, const Progress& progress = {});

}  // namespace orchard
