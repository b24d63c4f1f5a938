#pragma once
#include <cstdint>
#include <span>

#include "orchard/geometry/surface.h"

namespace orchard {

// The volume of a union of balls that lies outside the solid, by counting points of a low-discrepancy sequence (R3) in
// the union's box: good to about 1 % with the default. Cubic mesh units. Parallel; the same on any number of threads.
// Throws InputError unless surface.solid().
double outside_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t points = 200'000);

}  // namespace orchard
