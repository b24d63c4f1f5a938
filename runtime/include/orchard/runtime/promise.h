#pragma once
#include "orchard/runtime/motion.h"

// A Motion is a promise. These tell whether it was kept.
namespace orchard::runtime {

// By how much a motion exceeds each bound of one that was promised before; 0: that bound holds. With s the seconds from
// one to the other and d the promised half-space, of length 1:
struct PromiseExcess {
  double position = 0;  // |y - (position + velocity s)| over drift s + M s^2 / 2: Lemma 4.1. A length
  double side = 0;      // of the same along d, over drift s: Lemma 4.2. A length
  double velocity = 0;  // |velocity - promised| over both drifts + M s: M itself. Lengths per second
  double turn = 0;      // of the same along d, over both drifts: d itself. Lengths per second
  double radius = 0;    // how much it has changed. A length

  bool none() const noexcept { return position == 0 && side == 0 && velocity == 0 && turn == 0 && radius == 0; }
};

// Of `given` at `time` over `promise` at `promise_time`; both are valid. None where the promise expired before, or was
// made after. What a velocity is at the time of expiry is left open, as it may jump there. Each is allowed kMotionSlack
// of the coordinates, positions `position_slack` besides, velocities and radii 1e-9 of themselves.
PromiseExcess promise_excess(const Motion& promise, double promise_time, const Motion& given, double time,
                             double position_slack = 0) noexcept;

// Whether a body that is at `position` now, with `velocity` unless that is null, has kept what was promised at
// `promise_time`: the same of the position and the velocity, whose drift is that of the promise. True once the promise
// has expired.
bool keeps_promise(const Motion& promise, double promise_time, double now, const Vec3& position, const Vec3* velocity,
                   double position_slack = 0) noexcept;

}  // namespace orchard::runtime
