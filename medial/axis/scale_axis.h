#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// Returns 1 for each ball that lies in another one after all balls have been enlarged `scale` times about their
// centres. Only larger balls count as covering ones, so that equal balls all stay. With scale 1 no ball is covered.
// Parallel; O(n log n) in practice.
std::vector<std::uint8_t> covered_when_scaled(std::span<const Point> centers, std::span<const double> radii,
                                              double scale);

}  // namespace orchard::detail
