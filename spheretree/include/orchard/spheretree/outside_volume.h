#pragma once
#include <cstdint>
#include <span>

#include "orchard/geometry/surface.h"

namespace orchard {

// The volume of the part of a union of balls that lies outside the solid, in cubic mesh units: counts points of a
// low-discrepancy sequence (R3) in the box of the union, and is good to about 1 % with the default number. Throws
// InputError unless surface.solid(). Parallel; the result does not depend on the thread count.
double outside_volume(const Surface& surface, std::span<const Sphere> balls, std::uint64_t points = 200'000);

}  // namespace orchard
