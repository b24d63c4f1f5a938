#pragma once
#include <vector>

#include "orchard/spheretree/sphere_set.h"

namespace orchard::detail {

// Returns a set of at most options.spheres spheres that covers the surface of a solid.
std::vector<Sphere> cover_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress);

// Returns the corners of each void that a union of balls has in the solid. Precondition: as for covers_solid().
std::vector<std::vector<Point>> voids_of(const Surface& surface, std::span<const Sphere> balls);

// Grows balls until covers_solid() holds, or up to a number of rounds that nearly always suffices. Precondition: the
// balls cover the surface.
void close_voids(const Surface& surface, std::vector<Sphere>& balls);

}  // namespace orchard::detail
