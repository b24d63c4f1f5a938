#pragma once
#include <vector>

#include "orchard/spheretree/sphere_set.h"

namespace orchard::detail {

// A set that covers the surface of a solid; no more spheres than asked for.
std::vector<Sphere> cover_set(const Surface& surface, const SphereSetOptions& options, const Progress& progress);

// Corners of the voids that a union of balls has in the solid, each void's together; precondition as covers_solid().
std::vector<std::vector<Point>> voids_of(const Surface& surface, std::span<const Sphere> balls);

// Grows balls until covers_solid(), or for a number of rounds that is enough as a rule. Precondition: they cover the
// surface.
void close_voids(const Surface& surface, std::vector<Sphere>& balls);

}  // namespace orchard::detail
