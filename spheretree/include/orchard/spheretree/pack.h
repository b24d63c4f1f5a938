#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// Packs a tree for the run-time: float nodes around a double origin, radii and bounds rounded outward so that every
// packed ball holds the ball that it came from, and for each leaf the triangles that meet its path region. A bound that
// measure() did not fill is packed as unknown, +infinity, and so is every bound on separation that rests on it. Throws
// Error if the tree has no root, is too large, or has a ball that is out of the run-time's range, which no ball near a
// mesh of a usable size is (mesh.h).
runtime::PackedSphereTree pack(const SphereTree& tree, const Surface& surface);
// The same of balls alone: around the root's centre, without triangles.
runtime::PackedSphereTree pack(const SphereTree& tree);

// The packed floats as a tree in the mesh's frame, with the stored bounds on distances; inaccuracies are not stored,
// and unknown. Precondition: structure_fault(packed) is nullptr.
SphereTree unpack(const runtime::PackedSphereTree& packed);

}  // namespace orchard
