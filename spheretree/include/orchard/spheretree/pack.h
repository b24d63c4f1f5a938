#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// The tree as the run-time takes it: float nodes around a double origin, radii and bounds rounded outward so that every
// packed ball holds the ball it came from, and for each leaf the triangles that meet its path region.
// Precondition: measure() filled the bounds.
runtime::PackedSphereTree pack(const SphereTree& tree, const Surface& surface);

}  // namespace orchard
