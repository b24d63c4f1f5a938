#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"

// Turns the space around a solid into a solid of its own, so that algorithms for the inside, such as the medial axis,
// also work on the outside. The boundary is the surface turned inside out, within a sphere around its bounding ball.
namespace orchard {

// Returns the boundary of the space around a solid: the triangles of `solid`, with the same numbers and two corners
// exchanged, followed by those of a sphere around the middle of its bounding ball. The sphere is an icosphere of 1280
// triangles whose vertices lie on it; `radius` is its radius in bounding radii, above 1.1 and finite. A cavity of the
// solid lies outside and becomes a component of its own.
// Throws InputError unless solid.solid(), and if `radius` is out of range. O(n log n).
TriangleMesh outside_solid(const Surface& solid, double radius = 2);

// Returns surface points of the outside: those that sample_surface() places on `solid`, and each vertex of the sphere.
// The sphere needs no more, since the medial axis near it does not depend on the shape of the solid. `outside` is the
// surface of outside_solid() of the same solid. The result is deterministic for options.seed.
SurfaceSampling sample_outside(const Surface& solid, const Surface& outside, const SamplingOptions& options = {},
                               const Progress& progress = {});

}  // namespace orchard
