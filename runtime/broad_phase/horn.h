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

struct PairPrecision {
  double resolution, slack;  // as of earliest_contact()
  bool valid = false;        // whether all motions are known to be valid
};

// Pair i, of at most kPairsAtOnce, is that of motions[2 i] and motions[2 i + 1], and has limits[i] seconds. Returns
// false if a motion may not be valid: nothing has been found then. The same bits on every machine.
bool find_pair_times(std::span<const Motion> motions, std::span<const double> limits, const PairPrecision& precision,
                     PairTimes& times) noexcept;

// Squares of less vanish: spheres_touch() takes it for 0.
inline constexpr double kMinLength = 1e-150;

// What to add to a sum of radii for the rounding of everything that follows, and the application's.
double motion_slack(const Motion& a, const Motion& b, double duration) noexcept;

}  // namespace orchard::runtime::detail
