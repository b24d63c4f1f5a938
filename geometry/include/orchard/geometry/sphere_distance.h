#pragma once
#include "orchard/geometry/surface.h"

// Estimates of the distance from a sphere to a solid, which is the largest distance to the surface from a point of the
// sphere's surface that lies outside the solid, or 0 if there is none (dissertation 5.3.2). The three estimates err in
// a known direction and cost a handful of distance queries each; covering/inaccuracy.h computes bounds on the true
// value. Lengths are in mesh units. All functions throw InputError unless surface.solid().
namespace orchard {

// Returns the estimate of Lemma 5.1: the radius plus the signed distance of the centre. It is exact for convex solids
// and an over-estimate for others. Costs one query.
double convex_sphere_distance(const Surface& surface, const Sphere& sphere);

// Returns the largest distance over the 20 vertices of the inscribed dodecahedron, which is an under-estimate. Costs 20
// queries.
double sampled_sphere_distance(const Surface& surface, const Sphere& sphere);

// Returns the sampled distance plus kDodecahedronGap radii, which is the largest distance from a point of the sphere to
// a vertex. This is an over-estimate, since the signed distance is 1-Lipschitz. Costs 20 queries.
double corrected_sphere_distance(const Surface& surface, const Sphere& sphere);

// The chord from the middle of a dodecahedron's face to its corners on the unit sphere, rounded up: 0.64085...
inline constexpr double kDodecahedronGap = 0.640852;

}  // namespace orchard
