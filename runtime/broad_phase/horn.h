#pragma once
#include "orchard/runtime/motion.h"

namespace orchard::runtime::detail {

// Two horns as one: the points meet when |offset + velocity t| <= radius + growth t + acceleration t^2 / 2.
struct HornPair {
  Vec3 offset, velocity;
  double radius, growth, acceleration;
};

inline constexpr int kMaxHornRounds =
    100;  // a grazing contact halves the gap per round; stopping early is early, not late

// The first such t in [0, limit], never late and less than `resolution` early; infinity if there is none.
double horn_contact(const HornPair& pair, double limit, double resolution) noexcept;

// A contact at a time not after the limit, by the two bodies' half-spaces: not before both allow it, and infinity if
// that is after the limit. `slack`: with that for rounding.
double tightened(const Motion& a, const Motion& b, double contact, double limit, double slack) noexcept;

// The first t >= 0 with gap + slope t - acceleration t^2 / 2 <= 0; infinity if there is none. acceleration >= 0.
double first_closing(double gap, double slope, double acceleration) noexcept;

// How long two overlapping spheres surely go on to overlap, at most `limit`: the bounds do not let them get apart
// sooner. `slack` as of earliest_contact().
double overlap_lasts(const Motion& a, const Motion& b, double limit, double slack) noexcept;

// Squares of less vanish: spheres_touch() takes it for 0.
inline constexpr double kMinLength = 1e-150;

// What to add to a sum of radii for the rounding of everything that follows, and the application's.
double motion_slack(const Motion& a, const Motion& b, double duration) noexcept;

}  // namespace orchard::runtime::detail
