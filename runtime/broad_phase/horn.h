#pragma once
#include <array>
#include <span>

#include "orchard/runtime/motion.h"

// When two bodies can touch, and how long they surely overlap, by the horns that their bounds allow (8.2).
namespace orchard::runtime::detail {

// Two horns as one: the points meet when |offset + velocity t| <= radius + growth t + acceleration t^2 / 2. Of one
// pair, or of four by coordinate.
template <typename Numbers>
struct Horns {
  std::array<Numbers, 3> offset, velocity;
  Numbers radius, growth, acceleration;
};
using HornPair = Horns<double>;

// The first such t in [0, limit], never late and less than `resolution` early; infinity if there is none.
double horn_contact(const HornPair& pair, double limit, double resolution) noexcept;

inline constexpr std::size_t kPairsAtOnce = 16;

struct PairTimes {
  std::array<bool, kPairsAtOnce> touching;  // spheres_touch()
  // Of those that touch, how long they surely go on to overlap, as the bounds do not let them get apart sooner; of the
  // others earliest_contact(); until their limits.
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

// Squares of less vanish: spheres_touch() takes it for 0.
inline constexpr double kMinLength = 1e-150;

// What to add to a sum of radii for the rounding of everything that follows, and the application's.
double motion_slack(const Motion& a, const Motion& b, double duration) noexcept;

}  // namespace orchard::runtime::detail
