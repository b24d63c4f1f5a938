#pragma once
#include "calendar.h"
#include "swept_grid.h"

namespace orchard::runtime::detail {

// What decides how long a window pays: means over the bodies looked at.
struct MotionMeans {
  double count = 0, radius = 0, speed = 0, drift = 0, acceleration = 0;  // sums; speed per axis

  void add(const Motion& motion) noexcept;
};

struct WindowPlan {
  double cell_size = 1;
  Step window = 1;
  std::size_t lines = 1;
  double pairs_per_body = 0;  // predicted for one look at all bodies
};

// The mean distance from a body to the next: (volume / bodies)^(1/3), of a sample's inner part, so that a few bodies
// far away do not matter.
double mean_spacing(std::span<const Vec3> sample, std::size_t bodies);

// The window with the least cost per step: a long one makes more boxes meet, a short one looks at bodies more often.
// `correction` multiplies the predicted number of pairs; fixed_window 0 leaves the choice.
WindowPlan plan_window(const MotionMeans& means, std::size_t bodies, double spacing, double time_step,
                       double correction, Step fixed_window) noexcept;

}  // namespace orchard::runtime::detail
