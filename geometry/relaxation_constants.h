#pragma once
#include <cstddef>

namespace orchard::detail {

// Both kinds of relaxation. Chosen for the most even result after 40 iterations.
inline constexpr double kRepulsionRadius = 2.0;       // in mean spacings, sqrt(area / points)
inline constexpr double kRelaxationStep = 0.15;       // in mean spacings, per unit of force
inline constexpr double kLongestStep = 0.5;           // in mean spacings
inline constexpr std::size_t kRelaxationGrain = 256;  // points a task

}  // namespace orchard::detail
