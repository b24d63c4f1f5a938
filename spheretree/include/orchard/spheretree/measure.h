#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tree.h"

// Measures the bounds and inaccuracies of a sphere-tree's nodes.
namespace orchard {

// Fills center_distance, distance_bound and inaccuracy of every node, in mesh units. If the surface is not solid,
// distances are unsigned and the inaccuracy is the distance bound. The work is parallel over nodes; the result does not
// depend on the number of threads. Source: dissertation 5.3.5 and 6.3.4.
void measure(SphereTree& tree, const Surface& surface, const Progress& progress = {});

// Fills the inaccuracy of every node only, with the same values as measure(), in about half the time. Use it for trees
// that only serve for comparison. `known` is a measured tree of the same surface; where it contains the same sphere,
// its value is copied.
void measure_inaccuracy(SphereTree& tree, const Surface& surface, const Progress& progress = {},
                        const SphereTree& known = {});

}  // namespace orchard
