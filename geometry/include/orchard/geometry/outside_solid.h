#pragma once
#include "orchard/geometry/mesh.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"

namespace orchard {

// The space around a solid as a solid of its own, so that all that is made for the inside, such as the medial axis, is
// made for the outside, too: the surface turned inside out, within a sphere around its bounding ball.

// The triangles of `solid`, with the same numbers and two corners exchanged, and after them those of a sphere of so
// many bounding radii around the middle of its bounding ball (an icosphere of 1280 triangles, whose vertices are on
// it). A cavity of the solid is outside, and so a component of its own. Throws InputError unless solid.solid(), and if
// `radius` is not above 1.1 and finite. O(n log n).
TriangleMesh outside_solid(const Surface& solid, double radius = 2);

// Points for it: those that sample_surface() puts on `solid`, and each vertex of the sphere, which needs no more: what
// is near it is no shape of the solid. `outside`: of outside_solid() of the same. Deterministic for options.seed.
SurfaceSampling sample_outside(const Surface& solid, const Surface& outside, const SamplingOptions& options = {},
                               const Progress& progress = {});

}  // namespace orchard
