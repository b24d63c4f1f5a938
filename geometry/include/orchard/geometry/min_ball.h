#pragma once
#include <span>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Ritter's bounding ball (Graphics Gems, 1990): holds every point, up to a few roundings that are added to the radius;
// typically 5 % above minimal. O(n). An empty span gives the ball of radius 0 at the origin.
Sphere ritter_ball(std::span<const Point> points);

// The radius of the ball around `center` that holds every point, rounded up past the roundings of its own computation.
double radius_around(const Point& center, std::span<const Point> points);

}  // namespace orchard
