#pragma once
#include "orchard/geometry/mesh.h"

namespace orchard {

// The points p with normal . p >= offset. The normal may have any length but zero; the offset counts in it.
struct HalfSpace {
  Vector normal = Vector::UnitZ();
  double offset = 0;  // mesh units, times the normal's length
};

// The part of a solid in a half-space, closed by a flat cap where the plane cuts it: outward-oriented and manifold,
// with new corners on the plane up to roundings. What lies in the half-space as a whole comes back as it is. Throws
// InputError if the mesh is no solid, cuts itself near the plane, or has nothing in the half-space, or if the plane has
// no direction (CGAL's Polygon_mesh_processing::clip).
TriangleMesh clip_solid(TriangleMesh mesh, const HalfSpace& kept);

}  // namespace orchard
