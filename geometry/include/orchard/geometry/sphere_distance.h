#pragma once
#include "orchard/geometry/surface.h"

// The distance from a sphere to a solid (dissertation 5.3.2): the largest distance to the surface from a point of the
// sphere's surface that lies outside the solid, 0 if none does. Three estimates of known direction, each a handful of
// distance queries; covering/inaccuracy.h brackets the truth itself. Lengths in mesh units. All throw InputError unless
// surface.solid().
namespace orchard {

// Lemma 5.1: the radius plus the signed distance of the centre. Exact for convex solids, an over-estimate for others.
// One query.
double convex_sphere_distance(const Surface& surface, const Sphere& sphere);

// The largest distance over the 20 vertices of the inscribed dodecahedron: an under-estimate. 20 queries.
double sampled_sphere_distance(const Surface& surface, const Sphere& sphere);

// The same plus kDodecahedronGap radii, the farthest that a point of the sphere can be from a vertex: an over-estimate,
// since the signed distance changes by no more than the way. 20 queries.
double corrected_sphere_distance(const Surface& surface, const Sphere& sphere);

// Chord from the middle of a dodecahedron's face to its corners on the unit sphere, rounded up: 0.64085...
inline constexpr double kDodecahedronGap = 0.640852;

}  // namespace orchard
