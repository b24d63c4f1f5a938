#pragma once
#include "broad_phase/quantized_grid.h"

namespace orchard::runtime::detail {

inline constexpr std::size_t kPairsAtOnce = 16;

struct PairTimes {
  std::array<bool, kPairsAtOnce> touching;  // spheres_touch()
  // Of those that touch overlap_lasts(), of the others earliest_contact(), until their limits.
  std::array<double, kPairsAtOnce> seconds;
};

// Pair i, of at most kPairsAtOnce, is that of motions[2 i] and motions[2 i + 1], and has limits[i] seconds. `slack` and
// `resolution` as of earliest_contact(). The motions are valid.
void find_pair_times(std::span<const Motion> motions, std::span<const double> limits, double resolution, double slack,
                     PairTimes& times) noexcept;

// The same, to the last bit, for four pairs at once, where the machine has vectors of four numbers. Does nothing and
// returns false where it has none, or a motion may not be valid.
bool find_pair_times_at_once(std::span<const Motion> motions, std::span<const double> limits, double resolution,
                             double slack, PairTimes& times) noexcept;

}  // namespace orchard::runtime::detail
