#pragma once
#include <cstddef>

namespace orchard::detail {

// The constants of both kinds of relaxation. They give the most even points after 40 iterations on flat, curved and
// sharp models.
inline constexpr double kRepulsionRadius = 2.0;       // in mean spacings, sqrt(area / points)
inline constexpr double kLongestStep = 0.5;           // in mean spacings
inline constexpr std::size_t kRelaxationGrain = 256;  // points in one task

// Returns the step of an iteration, in mean spacings per unit of force. The first steps are large, to spread the random
// points; the last ones are small, so that the points come to rest.
inline double relaxation_step(int iteration, int iterations) {
  return 0.4 - 0.3 * (iterations > 1 ? static_cast<double>(iteration) / (iterations - 1) : 0.0);
}

}  // namespace orchard::detail
