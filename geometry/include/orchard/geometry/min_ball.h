#pragma once
#include <span>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Ritter's bounding ball (Graphics Gems, 1990): holds every point, up to a few roundings that are added to the radius;
// typically 5 % above minimal. O(n). An empty span gives the ball of radius 0 at the origin.
Sphere ritter_ball(std::span<const Point> points);

// The smallest ball that holds every point, to about 1e-12 of its radius, through CGAL's Min_sphere_of_spheres_d
// (Fischer and Gaertner 2003); where that fails in doubles, it is repeated in exact arithmetic on the few points that
// matter. O(n) in practice. An empty span gives the ball of radius 0 at the origin.
Sphere minimal_ball(std::span<const Point> points);

// The radius of the ball around `center` that holds every point, rounded up past the roundings of its own computation.
double radius_around(const Point& center, std::span<const Point> points);

}  // namespace orchard
