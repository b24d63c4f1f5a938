#include <algorithm>
#include <cmath>

#include "detector/detector_state.h"
#include "math/vector_functions.h"

// Bodies are added, changed and removed between two steps.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::PartRecord;

namespace {

bool are_valid(const BodyOptions& options) noexcept {
  return options.continuous_speed >= 0 && options.continuous_speed <= kMaxNumber && options.reach >= 0 &&
         options.reach <= kMaxNumber;
}

}  // namespace

bool Detector::State::acceptable(std::span<const BodyPart> parts, const BodyOptions& options) const noexcept {
  if (!takes_changes() || parts.empty() || !are_valid(options)) return false;
  return std::all_of(parts.begin(), parts.end(), [this](const BodyPart& part) {
    PartRecord trial;
    return world.shapes.contains(part.shape) && detail::set_local(trial, world.shapes[part.shape], part.local);
  });
}

Body& Detector::State::add(BodyId id, std::span<const BodyPart> parts, const BodyOptions& with) {
  Body& body = world.bodies.add(id, parts.size());
  ++world.body_count;
  ++world.changes;
  body.options = with;
  world.any.own_filter = world.any.own_filter || detail::PartPairs::broad_filter(body) != BodyFilter{};
  world.any.parts = world.any.parts || parts.size() > 1;
  if (body.is_continuous() && !world.any.continuous) rely_on_origins();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    PartRecord& added = body.parts()[i];
    added.shape = parts[i].shape;
    detail::set_local(added, world.shapes[added.shape], parts[i].local);
  }
  body.since = world.answered + 1;
  body.extent.reach = std::max(with.reach, detail::reach_of(body.parts()));
  if (!world.any.continuous && !with.suggest && !(with.reach > 0)) body.find_middle();
  return body;
}

// Sweeps rely on the motion of the origins between two steps. So middles are given up, and so is the search by parts,
// which compares the spheres of one step only.
void Detector::State::rely_on_origins() {
  world.any.continuous = true;
  part_pairs.choose_none();
  for (BodyIndex i = 0; i < world.bodies.slots(); ++i) {
    Body& body = world.bodies[i];
    if (body.id == kNoBody || body.is_static || !body.has_middle()) continue;
    body.forget_middle();
    sampler.cancel(body);
  }
}

BodyId Detector::add_body(std::span<const BodyPart> parts, const BodyOptions& options) {
  State& s = *state_;
  if (!s.acceptable(parts, options) || (options.suggest && !s.sampler.watches()) || !s.sampler.source()) return kNoBody;
  return s.or_fail([&] {
    const BodyId id = s.broad.add(options.importance, options.filter);
    if (id == kNoBody) return id;
    s.add(id, parts, options);
    if (s.world.kept_states) s.world.kept_states->put(id.index, s.world.time_of_last_step(), {});
    if (s.sampler.watches()) s.sampler.monitor().begin(id.index);
    s.world.half_space_times.update_again(id.index);
    return id;
  });
}

// A static body does not move, so the drift that motion() adds for a middle is removed.
bool Detector::State::place_static(Body& body, const Pose& pose) {
  const Pose before = std::exchange(body.state.pose, pose);
  Motion place = body.motion(world.clock.time_step, body.has_middle());
  place.drift = 0;
  if (!broad.move_static(body.id, place)) {
    body.state.pose = before;
    return false;
  }
  world.bodies.moved(body.id.index, before);
  body.steps.moved = world.answered + 1;
  ++world.static_changes;
  return true;
}

BodyId Detector::add_static(std::span<const BodyPart> parts, const Pose& pose, const BodyOptions& options) {
  State& s = *state_;
  if (!s.acceptable(parts, options) || !is_rigid(pose)) return kNoBody;
  const Motion somewhere{.position = pose.translation};
  if (!is_valid(somewhere)) return kNoBody;
  return s.or_fail([&] {
    const BodyId id = s.broad.add_static(somewhere, options.importance, options.filter);
    if (id == kNoBody) return id;
    Body& body = s.add(id, parts, options);
    body.is_static = true;
    s.world.half_space_times.forget(id.index);
    if (!s.place_static(body, pose)) {
      remove(id);  // the body is too large
      return kNoBody;
    }
    s.world.any.static_body = true;
    return id;
  });
}

BodyId Detector::add_half_space(const Vec3& normal, double offset, const BodyOptions& options) {
  State& s = *state_;
  const detail::ScaledVector scaled(normal);
  const double size = length(Vec3(scaled.value)), height = std::ldexp(offset, scaled.power) / size;
  if (!s.takes_changes() || !are_valid(options) || !(size > 0) || !(std::fabs(height) <= kMaxNumber)) return kNoBody;
  Body body;
  body.options.filter = options.filter, body.options.importance = options.importance;
  body.since = body.steps.moved = s.world.answered + 1;
  return s.or_fail([&] {
    const BodyIndex index = s.world.halves.add({(1 / size) * Vec3(scaled.value), height}, body);
    s.world.half_space_times.update_all();
    ++s.world.body_count;
    ++s.world.changes;
    return s.world.halves.body(index).id;
  });
}

bool Detector::remove(BodyId id) {
  State& s = *state_;
  return s.change(id, [&](Body& body) {
    --s.world.body_count;
    if (is_half_space(id.index)) return s.world.halves.remove(id.index);
    if (body.is_static) ++s.world.static_changes;
    s.part_pairs.gone(body);
    s.world.bodies.leave(id.index);
    s.world.half_space_times.forget(id.index);
    return s.broad.remove(id);
  });
}

bool Detector::cancel(BodyId id) {
  return state_->change(id, [this](Body& body) { return state_->sampler.cancel(body), true; });
}

bool Detector::teleport(BodyId id) {
  State& s = *state_;
  return s.change(id, [&](Body& body) {
    if (body.is_static) return false;
    body.frozen = false;
    body.steps.asked = body.steps.known_before = detail::kNotAsked;
    ++body.changes.jumps;
    s.world.any.jump = true;
    s.sampler.monitor().forget(id.index);
    s.sampler.cancel(body);
    return true;
  });
}

bool Detector::move_static(BodyId id, const Pose& pose) {
  return state_->change(id, [&](Body& body) {
    return body.is_static && !is_half_space(id.index) && is_rigid(pose) && state_->place_static(body, pose);
  });
}

bool Detector::set_local(BodyId id, std::size_t part, const Pose& local) {
  constexpr double kStretchAhead = 1 + 0x1p-4;  // so that a reach that grows slowly does not cancel bounds at each step
  State& s = *state_;
  return s.change(id, [&](Body& body) {
    if (part >= body.parts().size()) return false;
    const PartRecord& record = body.parts()[part];
    const detail::Shape& shape = s.world.shapes[record.shape];
    PartRecord place = record;
    if (!detail::set_local(place, shape, local)) return false;
    const double reach = detail::reach_of(place);
    const Body::Extent before = body.extent;
    const bool stretches = reach > before.reach, grows = stretches || body.has_middle();
    if (stretches) body.extent.reach = kStretchAhead * reach;
    body.forget_middle();
    // A body that has become too large is refused before anything else has changed.
    if (!(body.extent.reach <= kMaxNumber) ||
        (grows && body.is_static && !s.place_static(body, Pose(body.state.pose)))) {
      body.extent = before;
      return false;
    }
    if (s.world.any.continuous) {
      body.parts_before.resize(body.parts().size());
      detail::PartBefore& was = body.parts_before[part];
      if (was.until != s.world.answered) was = {record, s.world.answered};
    }
    s.world.bodies.move_part(id.index, part, place, shape);
    body.steps.moved = s.world.answered + 1;
    if (stretches) body.stretched = s.world.answered;
    if (body.is_static)
      ++s.world.static_changes;
    else if (grows)
      s.sampler.cancel(body);
    return true;
  });
}

bool Detector::set_importance(BodyId id, std::uint8_t importance) {
  return state_->change(id, [&](Body& body) {
    body.options.importance = importance;
    return is_half_space(id.index) || state_->broad.set_importance(id, importance);
  });
}

bool Detector::set_filter(BodyId id, const BodyFilter& filter) {
  State& s = *state_;
  return s.change(id, [&](Body& body) {
    body.options.filter = filter;
    ++body.changes.filters;
    s.world.any.own_filter = true;
    return is_half_space(id.index) || s.broad.set_filter(id, detail::PartPairs::broad_filter(body));
  });
}

bool Detector::State::set_asleep(BodyId id, bool asleep) {
  return change(id, [&](Body& body) {
    if (body.is_static) return false;
    if (std::exchange(body.asleep, asleep) == asleep) return true;
    if (!asleep) world.wake(body);
    if (asleep && world.kept_states) world.keep_state(body, world.state(body));
    sampler.cancel(body);
    return true;
  });
}

bool Detector::sleep(BodyId id) { return state_->set_asleep(id, true); }

bool Detector::wake(BodyId id) { return state_->set_asleep(id, false); }

bool Detector::asleep(BodyId id) const noexcept { return state_->contains(id) && state_->world.body(id.index).asleep; }

bool Detector::shape_changed(ShapeId shape) {
  State& s = *state_;
  if (s.stepping || !s.world.shapes.contains(shape)) return false;
  s.world.shapes.changed(shape);
  ++s.world.changes;
  for (BodyIndex i = 0; i < s.world.bodies.slots(); ++i) {
    Body& body = s.world.bodies[i];
    const auto uses = [shape](const PartRecord& part) { return part.shape == shape; };
    const auto parts = body.parts();
    if (body.id == kNoBody || std::none_of(parts.begin(), parts.end(), uses)) continue;
    body.steps.moved = s.world.answered + 1;
    s.world.bodies.invalidate(i);
    ++body.changes.deformed;
  }
  return true;
}

void Detector::set_pair_filter(PairFilter filter) {
  State& s = *state_;
  if (s.stepping) return;
  ++s.world.filter_version;
  s.or_fail([&] {
    s.world.filter = filter;
    s.broad.set_pair_filter(std::move(filter));
    return true;
  });
}

// The following functions are for detectors that keep the states of bodies.

BodyId Detector::add_body(ShapeId shape, const BodyState& state, const BodyOptions& options) {
  if (!state_->world.kept_states || !detail::is_valid(state)) return kNoBody;
  const BodyId id = add_body({{shape}}, options);
  if (id != kNoBody) set_state(id, state);
  return id;
}

bool Detector::set_state(BodyId id, const BodyState& state) {
  State& s = *state_;
  return s.change(id, [&](Body& body) {
    if (!s.world.kept_states || body.is_static || !detail::is_valid(state)) return false;
    s.world.wake(body);
    s.world.keep_state(body, state);
    if (!s.sampler.watches() || body.asleep) s.sampler.cancel(body);
    return true;
  });
}

bool Detector::set_velocity(BodyId id, const Vec3& velocity) {
  BodyState now = state(id);
  now.velocity = velocity;
  return set_state(id, now);
}

BodyState Detector::state(BodyId id) const noexcept {
  const State& s = *state_;
  if (!s.contains(id)) return {};
  return s.world.state(s.world.body(id.index));
}

bool Detector::moves(BodyId id) const noexcept {
  return state_->contains(id) && !state_->world.body(id.index).is_static;
}

}  // namespace orchard::runtime
