#pragma once
#include <cstdint>
#include <span>

#include "orchard/geometry/surface.h"

namespace orchard {

// The volume of the part of a union of balls that lies outside the solid, in cubic mesh units: what parallel rays have
// of it, exactly along each, at places of a low-discrepancy sequence (R2) across the union's box. Good to about .3 %
// with the default number, and with fewer rays the error grows about as their number falls. The time goes as the rays,
// plus how often triangles and balls meet them. Throws InputError unless surface.solid().
double outside_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t rays = 10'000);

}  // namespace orchard
