#pragma once
#include "orchard/geometry/mesh.h"

// Wraps any triangles in a solid.
namespace orchard {

// The options of wrap_mesh(). Lengths are fractions of the diagonal of the bounding box.
struct WrapOptions {
  // Openings narrower than this stay closed. Smaller values follow the shape more closely and cost more.
  double alpha = 0.01;
  double offset = 0.002;  // The approximate distance of the wrap from the mesh.
};

// Returns a closed, manifold, outward-oriented mesh without self-intersections that encloses any triangles. A surface
// with openings wider than alpha is wrapped on both sides. The result has about 1 / alpha^2 triangles.
// Throws InputError if validate(mesh) does, if an option is not in (0, 1), or if the mesh has no extent. Takes seconds.
// Source: CGAL's Alpha_wrap_3; Portaneri et al. 2022.
TriangleMesh wrap_mesh(const TriangleMesh& mesh, const WrapOptions& options = {});

}  // namespace orchard
