#pragma once
#include <vector>

#include "orchard/spheretree/sphere_set.h"

namespace orchard::detail {

// Returns about `count` balls in the solid that touch its surface at two places or more, spread as surface points are.
// Their radii are smaller than the distance to the surface by a few rounding errors.
std::vector<Sphere> inscribed_balls(const Surface& surface, Index count, std::uint64_t seed);

// Returns the largest ball around a place that certainly lies in the solid. Its radius is 0 or less if there is none.
Sphere inscribed_ball(const Surface& surface, const Point& center);

// Adds balls in the solid until there are `count` of them. Each is the largest one that stays apart from the others. No
// covered place becomes uncovered, and the protrusion does not grow.
void add_inner_balls(const Surface& surface, Index count, double min_radius, std::vector<Sphere>& balls);

// Returns as many balls as options.spheres for the fit inside or balanced.
std::vector<Sphere> filled_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress);

}  // namespace orchard::detail
