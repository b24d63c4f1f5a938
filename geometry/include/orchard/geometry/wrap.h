#pragma once
#include "orchard/geometry/mesh.h"

namespace orchard {

// Lengths as fractions of the diagonal of the bounding box.
struct WrapOptions {
  double alpha = 0.01;    // openings narrower than this stay closed; small values follow the shape and cost more
  double offset = 0.002;  // about how far outside the wrap lies
};

// A closed, manifold, outward-oriented mesh without self-intersections that encloses any triangles (CGAL's
// Alpha_wrap_3; Portaneri et al. 2022). A surface whose openings are wider than alpha is wrapped on both sides. About
// 1 / alpha^2 triangles; seconds. Throws InputError if validate(mesh) does, if an option is not in (0, 1), or if the
// mesh has no extent.
TriangleMesh wrap_mesh(const TriangleMesh& mesh, const WrapOptions& options = {});

}  // namespace orchard
