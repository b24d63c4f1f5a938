#pragma once
#include <vector>

#include "orchard/spheretree/sphere_set.h"

namespace orchard::detail {

// Balls in the solid that touch its surface in two places or more, about so many, spread as surface points are; radii a
// few roundings smaller than the distance to the surface.
std::vector<Sphere> inscribed_balls(const Surface& surface, Index count, std::uint64_t seed);

// The largest ball around a place that surely lies in the solid; its radius is not above 0 where there is none.
Sphere inscribed_ball(const Surface& surface, const Point& center);

// Adds balls in the solid until there are `count`: the largest that keep apart. What is covered stays so, and nothing
// more sticks out.
void add_inner_balls(const Surface& surface, Index count, double min_radius, std::vector<Sphere>& balls);

// A set of the fit inside or balanced: as many balls as options.spheres.
std::vector<Sphere> filled_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress);

}  // namespace orchard::detail
