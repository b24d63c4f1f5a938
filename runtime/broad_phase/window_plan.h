#pragma once
#include "broad_phase/swept_grid.h"
#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

inline constexpr std::size_t kSample = 48;  // the maximum number of bodies in the sample for a plan

// Means over a sample of the bodies, which determine the best length of windows.
struct MeanMotion {
  double radius = 0, drift = 0, acceleration = 0;
  Vec3 speed{};  // along each axis, relative to a velocity
};
MeanMotion mean_of(std::span<const Motion> sample, const Vec3& velocity) noexcept;
// Returns a velocity that most bodies approximately share; 0 unless they are much slower relative to it.
Vec3 crowd_velocity(std::span<const Motion> sample) noexcept;

// The length of windows, and the cells of the grid.
struct WindowPlan {
  double cell_size = 1;
  Step window = 1;
  std::size_t lines = 1;
  double pairs_per_body = 0;  // predicted for one update of all windows
  bool slow = false;          // bodies move by less than half of their radius within a window
  bool roomy = false;         // cells are larger than boxes: smaller ones would have fewer bodies in each
};

// How the bodies are distributed in space.
struct Spread {
  double spacing = 0;          // the mean distance of neighbouring bodies; 0: not known
  Vec3 extent{};               // the approximate extent of the world
  Vec3 middle{};               // the middle of that
  std::array<bool, 3> thin{};  // the axes along which the world is thinner than the spacing, so no cells are needed
};

// Estimates the distribution of `bodies` bodies from at most kSample of them. The spacing is (volume / bodies)^(1/3),
// in flat worlds (area / bodies)^(1/2), and in thin ones length / bodies. These are measured in the inner part of the
// sample, so a few bodies far away do not matter.
Spread spread_of(std::span<const Motion> sample, std::size_t bodies);

// Returns the window with the least cost per step. With a longer window, more boxes meet; with a shorter one, bodies
// are updated more often. `correction` multiplies the predicted number of pairs. If `fixed_window` is not 0, it is the
// window. `cancelled` is the share of the bodies whose bounds are cancelled at a step, which makes long windows
// useless.
WindowPlan plan_window(const MeanMotion& mean, std::size_t bodies, const Spread& spread, double time_step,
                       double correction, Step fixed_window, double cancelled) noexcept;

}  // namespace orchard::runtime::detail
