#include <algorithm>
#include <cmath>

#include "detector/detector_state.h"
#include "math/vector_functions.h"

// Bodies come, change and go between two steps.
namespace orchard::runtime {

using detail::Body;
using detail::is_half_space;
using detail::PartRecord;

namespace {

// Of a body whose parts go farther out than ever: so that it need not be told of each step on the way.
constexpr double kStretchAhead = 1 + 0x1p-4;

bool are_valid(const BodyOptions& options) noexcept {
  return options.continuous_speed >= 0 && options.continuous_speed <= kMaxNumber && options.reach >= 0 &&
         options.reach <= kMaxNumber;
}

}  // namespace

bool Detector::State::acceptable(std::span<const BodyPart> parts) const noexcept {
  if (!takes_changes() || parts.empty()) return false;
  return std::all_of(parts.begin(), parts.end(), [this](const BodyPart& part) {
    PartRecord trial;
    return world.shapes.contains(part.shape) && detail::set_local(trial, world.shapes[part.shape], part.local);
  });
}

Body& Detector::State::add(BodyId id, std::span<const BodyPart> parts, const BodyOptions& with) {
  Body& body = world.bodies.add(id, parts.size());
  ++world.body_count;
  ++world.changes;
  body.set_filter(with.filter);
  world.any.own_filter = world.any.own_filter || detail::PartPairs::broad_filter(body) != BodyFilter{};
  body.importance = with.importance;
  body.suggest = with.suggest;
  body.continuous_speed = with.continuous_speed;
  if (with.continuous_speed > 0 && !world.any.continuous) {
    world.any.continuous = true;
    world.bodies.keep_before();
    rely_on_origins();
  }
  body.min_reach = with.reach;
  for (const BodyPart& part : parts) {
    PartRecord& added = body.parts.emplace_back();
    added.shape = part.shape;
    detail::set_local(added, world.shapes[part.shape], part.local);
  }
  world.bodies.parts_changed(id.index);
  body.since = world.answered + 1;
  body.reach = std::max(body.min_reach, detail::reach_of(body.parts));
  if (!world.any.continuous && !body.suggest && !(with.reach > 0)) detail::find_middle(body);
  changed(body);
  body.moved = -1;
  return body;
}

// A sweep relies on what origins do between steps, and not on middles, nor on where parts are at a step.
void Detector::State::rely_on_origins() {
  part_pairs.choose_none();
  for (BodyIndex i = 0; i < world.bodies.slots(); ++i) {
    Body& body = world.bodies[i];
    if (body.id == kNoBody || body.is_static || !body.has_middle()) continue;
    detail::forget_middle(body);
    cancel(body);
  }
}

BodyId Detector::add_body(std::span<const BodyPart> parts, const BodyOptions& options) {
  State& s = *state_;
  if (!s.acceptable(parts) || !are_valid(options) || (options.suggest && !s.sampler.watches()) ||
      !s.world.bodies.has_source())
    return kNoBody;
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

Motion Detector::State::place_of(const Body& body) const noexcept {
  Motion place = world.bodies.motion_of(body.id.index, world.clock.time_step, body.has_middle());
  place.drift = 0;
  return place;
}

BodyId Detector::add_static(std::span<const BodyPart> parts, const Pose& pose, const BodyOptions& options) {
  State& s = *state_;
  if (!s.acceptable(parts) || !are_valid(options) || !is_rigid(pose)) return kNoBody;
  Motion somewhere;
  somewhere.position = pose.translation;
  if (!is_valid(somewhere)) return kNoBody;
  return s.or_fail([&] {
    const BodyId id = s.broad.add_static(somewhere, options.importance, options.filter);
    if (id == kNoBody) return id;
    Body& body = s.add(id, parts, options);
    body.is_static = true;
    body.moved = s.world.answered + 1;
    s.world.bodies.state(id.index).pose = pose;
    s.world.bodies.moved(id.index, pose);
    s.world.half_space_times.forget(id.index);
    if (s.broad.move_static(id, s.place_of(body))) {
      s.world.any.static_body = true;
      ++s.world.static_changes;
      return id;
    }
    remove(id);  // too large
    return kNoBody;
  });
}

BodyId Detector::add_half_space(const Vec3& normal, double offset, const BodyOptions& options) {
  State& s = *state_;
  const detail::ScaledVector scaled(normal);
  const double size = length(Vec3(scaled.value)), height = std::ldexp(offset, scaled.power) / size;
  if (!s.takes_changes() || !are_valid(options) || !(size > 0) || !(std::fabs(height) <= kMaxNumber)) return kNoBody;
  Body body;
  body.set_filter(options.filter);
  body.importance = options.importance;
  body.since = s.world.answered + 1;
  return s.or_fail([&] {
    const BodyIndex index = s.world.halves.add({(1 / size) * Vec3(scaled.value), height}, body);
    s.world.halves.body(index).moved = s.world.answered + 1;
    s.world.half_space_times.update_all(s.world.bodies.slots());
    ++s.world.body_count;
    ++s.world.changes;
    return s.world.halves.body(index).id;
  });
}

// To change it.
Body* Detector::State::find(BodyId body) noexcept {
  if (stepping || !contains(body)) return nullptr;
  ++world.changes;
  return is_half_space(body.index) ? &world.halves.body(body.index) : &world.bodies[body.index];
}

void Detector::State::cancel(Body& body) {
  or_fail([&] {
    sampler.cancel(body);
    return true;
  });
}

bool Detector::remove(BodyId body) {
  State& s = *state_;
  const Body* found = s.find(body);
  if (found == nullptr) return false;
  --s.world.body_count;
  if (is_half_space(body.index)) return s.world.halves.remove(body.index);
  if (found->is_static) ++s.world.static_changes;
  s.part_pairs.gone(*found);
  s.world.bodies.leave(body.index);
  return s.or_fail([&] {
    s.world.half_space_times.forget(body.index);
    return s.broad.remove(body);
  });
}

bool Detector::cancel(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr) return false;
  state_->cancel(*found);
  return true;
}

bool Detector::teleport(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr || found->is_static) return false;
  found->frozen = false;
  found->asked = found->known_before = detail::kNotAsked;
  ++found->jumps;
  state_->world.any.jump = true;
  state_->sampler.monitor().forget(body.index);
  state_->cancel(*found);
  return true;
}

bool Detector::move_static(BodyId body, const Pose& pose) {
  State& s = *state_;
  Body* found = s.find(body);
  if (found == nullptr || !found->is_static || is_half_space(body.index) || !is_rigid(pose)) return false;
  const Pose before = s.world.bodies.state(body.index).pose;
  s.world.bodies.state(body.index).pose = pose;
  if (!s.or_fail([&] { return s.broad.move_static(body, s.place_of(*found)); })) {
    s.world.bodies.state(body.index).pose = before;
    return false;
  }
  s.world.bodies.moved(body.index, before);
  s.changed(*found);
  ++s.world.static_changes;
  return true;
}

bool Detector::set_local(BodyId body, std::size_t part, const Pose& local) {
  State& s = *state_;
  Body* found = s.find(body);
  if (found == nullptr || part >= found->parts.size()) return false;
  const detail::PartRecord& record = found->parts[part];
  detail::PartPlace place;
  if (!detail::set_local(place, s.world.shapes[record.shape], local)) return false;
  const double reach = detail::reach_of(place), reach_before = found->reach, middle_before = found->middle_reach;
  const bool stretches = reach > reach_before, grows = stretches || found->has_middle();
  if (stretches) found->reach = kStretchAhead * reach;
  detail::forget_middle(*found);
  // What is too large is told before anything has changed.
  if (!(found->reach <= kMaxNumber) ||
      (grows && found->is_static && !s.or_fail([&] { return s.broad.move_static(body, s.place_of(*found)); }))) {
    found->reach = reach_before, found->middle_reach = middle_before;
    return false;
  }
  if (s.world.any.continuous) {
    found->parts_before.resize(found->parts.size());
    detail::PartBefore& before = found->parts_before[part];
    if (before.until != s.world.answered) before = {record, s.world.answered};
  }
  s.world.bodies.move_part(body.index, part, place, s.world.shapes[record.shape]);
  s.changed(*found);
  if (stretches) found->stretched = s.world.answered;
  if (grows && !found->is_static) s.cancel(*found);
  if (found->is_static) ++s.world.static_changes;
  return true;
}

bool Detector::set_importance(BodyId body, std::uint8_t importance) {
  Body* found = state_->find(body);
  if (found == nullptr) return false;
  found->importance = importance;
  return is_half_space(body.index) || state_->or_fail([&] { return state_->broad.set_importance(body, importance); });
}

bool Detector::set_filter(BodyId body, const BodyFilter& filter) {
  Body* found = state_->find(body);
  if (found == nullptr) return false;
  found->set_filter(filter);
  ++found->filters;
  state_->world.any.own_filter = true;
  if (is_half_space(body.index)) return true;
  return state_->or_fail([&] { return state_->broad.set_filter(body, detail::PartPairs::broad_filter(*found)); });
}

bool Detector::sleep(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr || found->is_static) return false;
  if (found->asleep) return true;
  found->asleep = true;
  return state_->or_fail([&] {
    if (state_->world.kept_states) state_->keep_state(*found, state(body));
    state_->cancel(*found);
    return true;
  });
}

bool Detector::wake(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr || found->is_static) return false;
  if (!found->asleep) return true;
  state_->world.wake(*found);
  found->asleep = false;
  state_->cancel(*found);
  return true;
}

bool Detector::asleep(BodyId body) const noexcept {
  return state_->contains(body) && state_->world.places.body(body.index).asleep;
}

bool Detector::shape_changed(ShapeId shape) {
  State& s = *state_;
  if (s.stepping || !s.world.shapes.contains(shape)) return false;
  s.world.shapes.changed(shape);
  ++s.world.changes;
  for (BodyIndex i = 0; i < s.world.bodies.slots(); ++i) {
    Body& body = s.world.bodies[i];
    const auto uses = [shape](const PartRecord& part) { return part.shape == shape; };
    if (body.id != kNoBody && std::any_of(body.parts.begin(), body.parts.end(), uses)) {
      s.changed(body);
      s.world.bodies.deformed(i);
      ++body.deformed;
    }
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

}  // namespace orchard::runtime
