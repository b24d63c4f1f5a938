#pragma once
#include "broad_phase/swept_grid.h"
#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

inline constexpr std::size_t kSample = 48;  // bodies, at most, that a plan is made by

// What decides how long a window pays: means over a sample of the bodies.
struct MeanMotion {
  double radius = 0, drift = 0, acceleration = 0;
  Vec3 speed{};  // along each axis, relative to a velocity
};
MeanMotion mean_of(std::span<const Motion> sample, const Vec3& velocity) noexcept;
// The velocity that most of them have about in common; 0 unless they are much slower relative to it.
Vec3 crowd_velocity(std::span<const Motion> sample) noexcept;

struct WindowPlan {
  double cell_size = 1;
  Step window = 1;
  std::size_t lines = 1;
  double pairs_per_body = 0;  // predicted for one update of all windows
  bool slow = false;          // bodies move by less than half of their radius within a window
  bool roomy = false;         // cells are larger than boxes: smaller ones would have fewer bodies in each
};

// How bodies lie in space.
struct Spread {
  double spacing = 0;          // the mean distance from a body to the next; 0: not known
  Vec3 extent{};               // of the world, about
  Vec3 middle{};               // of it
  std::array<bool, 3> thin{};  // along which the world is thinner than the spacing: it does not set bodies apart
};

// The spacing is (volume / bodies)^(1/3), in flat worlds (area / bodies)^(1/2) and in thin ones length / bodies, of a
// sample's inner part, so that a few bodies far away do not matter. At most kSample of them are taken.
Spread spread_of(std::span<const Motion> sample, std::size_t bodies);

// The window with the least cost per step: a long one makes more boxes meet, a short one updates bodies more often.
// `correction` multiplies the predicted number of pairs; fixed_window 0 leaves the choice. `cancelled`: of the bodies,
// the share whose bounds end before their time at a step, for which a long window would be in vain.
WindowPlan plan_window(const MeanMotion& mean, std::size_t bodies, const Spread& spread, double time_step,
                       double correction, Step fixed_window, double cancelled) noexcept;

}  // namespace orchard::runtime::detail
