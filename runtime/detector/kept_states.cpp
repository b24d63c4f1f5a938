#include "detector/kept_states.h"

#include "detector/detector_state.h"

namespace orchard::runtime {
namespace detail {

void KeptStates::put(BodyIndex body, double time, const BodyState& state) {
  grow(told_, std::size_t{body} + 1);
  told_[body] = {state, time};
}

BodyState KeptStates::at(double time, BodyIndex body) const noexcept {
  const Told& told = told_[body];
  BodyState state = told.state;
  state.pose.translation = Vec3(state.pose.translation) + (time - told.time) * state.velocity;
  return state;
}

// No body turns until its state is changed, which cancels its bounds.
void KeptStates::fill(double time, std::span<const BodyIndex> bodies, std::span<BodyState> states) const noexcept {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    states[i] = at(time, bodies[i]);
    if (put_cancels_) states[i].angular_speed = 0;
  }
}

}  // namespace detail

// What sleeps is at rest.
void Detector::State::keep_state(const detail::Body& body, BodyState state) {
  if (body.asleep) state.velocity = {};
  world.kept_states->put(body.id.index, world.time_of_last_step(), state);
}

BodyId Detector::add_body(ShapeId shape, const BodyState& state, const BodyOptions& options) {
  if (!state_->world.kept_states || !detail::is_valid(state)) return kNoBody;
  const BodyId id = add_body({{shape}}, options);
  if (id != kNoBody) set_state(id, state);
  return id;
}

bool Detector::set_state(BodyId body, const BodyState& state) {
  State& s = *state_;
  detail::Body* found = s.find(body);
  if (found == nullptr || !s.world.kept_states || !moves(body) || !detail::is_valid(state)) return false;
  s.world.wake(*found);
  return s.or_fail([&] {
    s.keep_state(*found, state);
    if (!s.sampler.watches() || found->asleep) s.cancel(*found);
    return true;
  });
}

bool Detector::set_velocity(BodyId body, const Vec3& velocity) {
  BodyState now = state(body);
  now.velocity = velocity;
  return set_state(body, now);
}

BodyState Detector::state(BodyId body) const noexcept {
  const State& s = *state_;
  if (!s.contains(body) || detail::is_half_space(body.index)) return {};
  if (s.world.kept_states && !s.world.bodies[body.index].is_static)
    return s.world.kept_states->at(s.world.time_of_last_step(), body.index);
  return s.world.bodies.state(body.index);
}

bool Detector::moves(BodyId body) const noexcept {
  return state_->contains(body) && !detail::is_half_space(body.index) && !state_->world.bodies[body.index].is_static;
}

}  // namespace orchard::runtime
