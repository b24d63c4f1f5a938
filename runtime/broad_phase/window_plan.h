#pragma once
#include "broad_phase/swept_grid.h"
#include "broad_phase/timing_wheel.h"

namespace orchard::runtime::detail {

// What decides how long a window pays: means over the bodies updated.
struct MotionMeans {
  static constexpr std::size_t kPlaces = 48;

  double count = 0, radius = 0, drift = 0, acceleration = 0;  // sums
  Vec3 speed{};                                               // sums, along each axis
  std::array<Vec3, kPlaces> places{}, velocities{};           // of some of them, no matter which
  Vec3 frame{};                                               // whose velocity speeds are relative to

  void add(const Motion& motion) noexcept;
  static constexpr std::size_t kStride = 16;  // of those updated, one in so many is looked at
  void add(std::span<const Motion> updated) noexcept {
    for (std::size_t i = 0; i < updated.size(); i += kStride) add(updated[i]);
  }
  // The velocity that most of them have about in common; 0 unless they are much slower relative to it.
  Vec3 crowd_velocity() const noexcept;
  void refer_to(const Vec3& velocity) noexcept;  // speeds are relative to it from now on
  std::span<const Vec3> sample() const noexcept { return std::span(places).first(sampled()); }

 private:
  std::size_t sampled() const noexcept { return std::min(kPlaces, static_cast<std::size_t>(count)); }
  double mean_speed(const Vec3& relative_to) const noexcept;  // of the sample, per axis
};

struct WindowPlan {
  double cell_size = 1;
  Step window = 1;
  std::size_t lines = 1;
  double pairs_per_body = 0;  // predicted for one update of all windows
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
// sample's inner part, so that a few bodies far away do not matter. O(1): of a sample of more than MotionMeans::kPlaces
// the rest is left out.
Spread spread_of(std::span<const Vec3> sample, std::size_t bodies);

// The window with the least cost per step: a long one makes more boxes meet, a short one updates bodies more often.
// `correction` multiplies the predicted number of pairs; fixed_window 0 leaves the choice. `cancelled`: of the bodies,
// the share whose bounds end before their time at a step, for which a long window would be in vain.
WindowPlan plan_window(const MotionMeans& means, std::size_t bodies, const Spread& spread, double time_step,
                       double correction, Step fixed_window, double cancelled) noexcept;

}  // namespace orchard::runtime::detail
