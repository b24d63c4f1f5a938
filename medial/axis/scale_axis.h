#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// For each ball whether, when all are enlarged `scale` times about their centres, it lies in another one: 1 if so. A
// ball counts only against larger ones, so that of equal balls all stay. With scale 1 nothing is covered. Parallel;
// O(n log n) in practice.
std::vector<std::uint8_t> covered_when_scaled(std::span<const Point> centers, std::span<const double> radii,
                                              double scale);

}  // namespace orchard::detail
