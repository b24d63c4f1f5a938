#pragma once
#include <span>

#include "orchard/geometry/mesh.h"

// Balls that contain sets of points.
namespace orchard {

// Returns Ritter's bounding ball, which contains every point because a few roundings are added to its radius. It is
// typically 5 % larger than the minimal ball. An empty span gives the ball of radius 0 at the origin. O(n). Source:
// Graphics Gems, 1990.
Sphere ritter_ball(std::span<const Point> points);

// Returns the smallest ball that contains every point, to about 1e-12 of its radius, by CGAL's Min_sphere_of_spheres_d.
// If that fails in doubles, it is repeated in exact arithmetic on the few points that matter. An empty span gives the
// ball of radius 0 at the origin. O(n) in practice. Source: Fischer and Gaertner 2003.
Sphere minimal_ball(std::span<const Point> points);

// Returns the radius of the ball around `center` that contains every point, rounded up beyond the roundings of its own
// computation.
double radius_around(const Point& center, std::span<const Point> points);

}  // namespace orchard
