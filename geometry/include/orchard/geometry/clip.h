#pragma once
#include "orchard/geometry/mesh.h"

// Cuts a solid by a plane.
namespace orchard {

// The points p with normal . p >= offset. The normal may have any length above zero.
struct HalfSpace {
  Vector normal = Vector::UnitZ();
  double offset = 0;  // In mesh units times the length of the normal.
};

// Returns the part of a solid in a half-space, closed by a flat cap where the plane cuts it. The result is oriented
// outward and manifold, and its new corners lie on the plane up to rounding. A solid that lies in the half-space is
// returned unchanged.
// Throws InputError if the mesh is not a solid, cuts itself near the plane or has no part in the half-space, or if the
// normal is zero. Uses CGAL's Polygon_mesh_processing::clip.
TriangleMesh clip_solid(TriangleMesh mesh, const HalfSpace& kept);

}  // namespace orchard
