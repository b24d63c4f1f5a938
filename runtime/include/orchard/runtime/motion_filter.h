#pragma once
#include <array>

#include "orchard/runtime/motion.h"

namespace orchard::runtime {

// What is known of a tracked object before its first sample, and of the tracker. Units are those of lengths and
// seconds.
struct MotionFilterOptions {
  double noise = 1e-3;      // standard deviation of each coordinate of a sample; positive
  double jerk_density = 1;  // within s seconds each coordinate of the acceleration changes at random, with the
                            // variance jerk_density s; positive. Higher values trust old samples less
  double max_speed = 10;    // standard deviation of each coordinate of the velocity before the first sample; 0 or more
  double max_acceleration = 100;  // the same of the acceleration; 0 or more
  double confidence = 0.99;       // probability with which a motion's bound holds; above 0, below 1
};

// A Kalman filter that predicts M and d of a tracked object from noisy samples of its position (dissertation 4.4): its
// state is position, velocity and acceleration, the last one a random walk. Samples may come at any times and may be
// missing. Use it where a user moves objects by a device that trembles; finite differences (motion_helpers.h) multiply
// the noise by 1 / step^2. Adding a sample and asking for a motion cost some tens of nanoseconds each; nothing is
// allocated.
class MotionFilter {
 public:
  explicit MotionFilter(const MotionFilterOptions& options = {}) noexcept;

  // Adds a sample. Returns false, and changes nothing, if its time is not later than the last one's, a number is not
  // finite, or an option is out of its range.
  bool add(double time, const Vec3& position) noexcept;
  // Forgets all samples: the object has jumped, or another one is tracked.
  void reset() noexcept { empty_ = true; }
  bool empty() const noexcept { return empty_; }

  // A bound as of `time`, which expires `horizon` seconds later, of the object whose bounding sphere has the radius
  // `radius`. With at least the stated confidence it holds all that time, if the object moves as the options say: the
  // radius is enlarged by how wrong the position may be, the drift is how wrong the velocity may be, M is the estimated
  // acceleration and how wrong it may be or become, and there is a half-space if that is less than the acceleration
  // itself. Precondition: not empty(), and `time` is not earlier than the last sample; if it is later, the filter
  // predicts, and the bound is wider.
  //
  // Why: position, velocity and acceleration are each wrong by a normal variable of known variance, equal along the
  // axes, so lengths follow the chi distribution of three degrees of freedom. A third of the doubt is given to each. By
  // Levy's inequality the largest change of a random walk exceeds a length at most twice as often as its last one.
  Motion motion(double radius, double time, double horizon) const noexcept;

 private:
  struct Covariance {  // of one axis, the same for all three: of position, velocity, acceleration
    double xx, xv, xa, vv, va, aa;
  };
  struct State {
    Vec3 position, velocity, acceleration;
    Covariance covariance;
  };
  State predicted(double seconds) const noexcept;

  MotionFilterOptions options_;
  bool usable_;                // the options
  double width_, walk_width_;  // standard deviations that a vector stays within, and a random walk
  State state_{};
  double time_ = 0;
  bool empty_ = true;
};

}  // namespace orchard::runtime
