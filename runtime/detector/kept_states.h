#pragma once
#include <span>
#include <vector>

#include "broad_phase/vectors.h"
#include "orchard/runtime/detector.h"

namespace orchard::runtime::detail {

// The states of bodies that the detector keeps for the application. Each body moves straight, at constant velocity,
// from the time at which its state was set.
class KeptStates {
 public:
  // `put_cancels`: each call of put() cancels the motion bounds of the body, so they need not hold any longer.
  explicit KeptStates(bool put_cancels) noexcept : put_cancels_(put_cancels) {}
  void put(BodyIndex body, double time, const BodyState& state) {
    grow(told_, std::size_t{body} + 1);
    told_[body] = {state, time};
  }
  BodyState at(double time, BodyIndex body) const noexcept {
    BodyState state = told_[body].state;
    state.pose.translation = Vec3(state.pose.translation) + (time - told_[body].time) * state.velocity;
    return state;
  }
  // Fills in the states of bodies at `time`. If put() cancels bounds, their angular speed is 0, since no body turns
  // between two calls of put().
  void fill(double time, std::span<const BodyIndex> bodies, std::span<BodyState> states) const noexcept {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      states[i] = at(time, bodies[i]);
      if (put_cancels_) states[i].angular_speed = 0;
    }
  }
  std::size_t memory_bytes() const noexcept { return bytes_of(told_); }

 private:
  struct Told {
    BodyState state;
    double time = 0;
  };
  std::vector<Told> told_;  // by BodyIndex
  bool put_cancels_;
};

}  // namespace orchard::runtime::detail
