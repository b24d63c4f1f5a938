#pragma once
#include <array>

#include "orchard/runtime/motion.h"

// Predicts motion bounds of tracked objects from noisy samples of their positions.
namespace orchard::broad_phase_methods {

using runtime::Motion;
using runtime::Vec3;

// The options of a MotionFilter: the error of the tracker, and a model of how the object moves. Units are those of
// lengths and seconds.
struct MotionFilterOptions {
  // The standard deviation of each coordinate of a sample, a length above 0.
  double noise = 1e-3;
  // How fast the acceleration changes at random, above 0: within s seconds, each coordinate of the acceleration changes
  // with the variance jerk_density s. Higher values rely less on old samples.
  double jerk_density = 1;
  // The standard deviations of each coordinate of the velocity and of the acceleration before the first sample, at
  // least 0.
  double max_speed = 10, max_acceleration = 100;
  // The probability with which the bounds of a motion hold, above 0 and below 1.
  double confidence = 0.99;
};

// A Kalman filter that predicts M and d of a tracked object from noisy samples of its position (dissertation 4.4). Its
// state is the position, the velocity and the acceleration, of which the last one is a random walk. Samples may come at
// any times and may be missing. Use it if a user moves objects by a device whose positions jitter; finite differences
// (motion_helpers.h) multiply the noise by 1 / step^2. Adding a sample and asking for a motion take some tens of
// nanoseconds each and allocate nothing.
class MotionFilter {
 public:
  explicit MotionFilter(const MotionFilterOptions& options = {}) noexcept;

  // Adds a sample. Returns false and changes nothing if its time is not later than that of the last sample, if a number
  // is not finite, or if an option is out of its range.
  bool add(double time, const Vec3& position) noexcept;
  // Forgets all samples. Call it if the object has jumped or if another object is tracked.
  void reset() noexcept { empty_ = true; }
  bool empty() const noexcept { return empty_; }

  // Returns a motion of the object with bounds from `time` on, which expire `horizon` seconds later. `radius` is the
  // radius of its bounding sphere. With at least the stated confidence the bounds hold until then, if the object moves
  // as the options say:
  // - the radius of the motion is larger by the largest error of the position;
  // - the drift is the largest error of the velocity;
  // - M is the estimated acceleration plus the largest error that it has or gets;
  // - there is a half-space if this error is less than the acceleration itself.
  // Precondition: not empty(), and `time` is not earlier than the last sample. If it is later, the filter predicts, and
  // the bounds are wider.
  //
  // Proof: the errors of position, velocity and acceleration are normal variables of known variance, equal along the
  // axes, so their lengths follow the chi distribution with three degrees of freedom. Each of the three gets a third of
  // the probability of failure. By Levy's inequality, the largest change of a random walk exceeds a length at most
  // twice as often as its last change does.
  Motion motion(double radius, double time, double horizon) const noexcept;

 private:
  // The covariances of position, velocity and acceleration along one axis; they are the same for all axes.
  struct Covariance {
    double xx, xv, xa, vv, va, aa;
  };
  struct State {
    Vec3 position, velocity, acceleration;
    Covariance covariance;
  };
  State predicted(double seconds) const noexcept;

  MotionFilterOptions options_;
  bool usable_;  // Whether the options are in range.
  // The numbers of standard deviations within which the length of a vector and of a random walk stay.
  double width_, walk_width_;
  State state_{};
  double time_ = 0;
  bool empty_ = true;
};

}  // namespace orchard::broad_phase_methods
