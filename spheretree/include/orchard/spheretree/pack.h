#pragma once
#include "orchard/geometry/surface.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/tree.h"

// Converts sphere-trees between the builder's doubles and the run-time's packed floats.
namespace orchard {

// Packs a tree for the run-time: float nodes around a double origin, and for each leaf the triangles that meet its path
// region. Radii and bounds are rounded outward, so that every packed ball contains the ball that it was made from. A
// bound that measure() did not fill is packed as unknown, +infinity, and so is every bound on separation that depends
// on it.
// Throws Error if the tree has no root, is too large, or has a ball beyond the range of the run-time. Balls near a mesh
// of a usable size (mesh.h) are never beyond it.
runtime::PackedSphereTree pack(const SphereTree& tree, const Surface& surface);
// Packs the balls only, around the centre of the root, without triangles.
runtime::PackedSphereTree pack(const SphereTree& tree);

// Returns the packed floats as a tree in the frame of the mesh, with the stored bounds on distances. Inaccuracies are
// not stored and are unknown in the result. Precondition: structure_fault(packed) is nullptr.
SphereTree unpack(const runtime::PackedSphereTree& packed);

}  // namespace orchard
