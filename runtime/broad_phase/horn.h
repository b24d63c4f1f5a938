#pragma once
#include <array>
#include <span>

#include "orchard/runtime/motion.h"

// When two bodies can touch, and how long they certainly overlap, computed from the horns of their motion bounds
// (dissertation 8.2).
namespace orchard::runtime::detail {

// The two horns of a pair, in relative coordinates: the bodies can touch at times t for which |offset + velocity t| <=
// radius + growth t + acceleration t^2 / 2. `Numbers` has the value of one pair, or those of four.
template <typename Numbers>
struct Horns {
  std::array<Numbers, 3> offset, velocity;
  Numbers radius, growth, acceleration;
};
using HornPair = Horns<double>;

// Returns the first such t in [0, limit], never too late and less than `resolution` too early; infinity if there is
// none.
double horn_contact(const HornPair& pair, double limit, double resolution) noexcept;

inline constexpr std::size_t kPairsAtOnce = 16;

struct PairTimes {
  std::array<bool, kPairsAtOnce> touching;  // spheres_touch()
  // For pairs that touch: how long they certainly overlap, because the bounds do not let them part sooner. For the
  // others: earliest_contact(). Both are searched up to the limits.
  std::array<double, kPairsAtOnce> seconds;
};

struct PairPrecision {
  double resolution, slack;  // the parameters of earliest_contact() with these names
  bool valid = false;        // whether all motions are known to be valid
};

// Computes the times of at most kPairsAtOnce pairs. Pair i has the motions 2 i and 2 i + 1 and is searched for
// limits[i] seconds. Returns false, without results, if a motion may be invalid. The results have the same bits on
// every machine.
bool find_pair_times(std::span<const Motion> motions, std::span<const double> limits, const PairPrecision& precision,
                     PairTimes& times) noexcept;

// Squares of smaller lengths underflow, so spheres_touch() treats them as 0.
inline constexpr double kMinLength = 1e-150;

// Returns what is added to the sum of two radii, to allow for rounding in all further computations and in the
// application.
double motion_slack(const Motion& a, const Motion& b, double duration) noexcept;

}  // namespace orchard::runtime::detail
