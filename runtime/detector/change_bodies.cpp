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
  if (!valid || failed || stepping || parts.empty()) return false;
  return std::all_of(parts.begin(), parts.end(), [this](const BodyPart& part) {
    PartRecord trial;
    return shapes.contains(part.shape) && detail::set_local(trial, shapes[part.shape], part.local);
  });
}

bool Detector::State::acceptable(const BodyOptions& with) const noexcept {
  return are_valid(with) && (watches || !with.suggest);
}

Body& Detector::State::take_in(BodyId id, std::span<const BodyPart> parts, const BodyOptions& with) {
  Body& body = bodies.take_in(id, parts.size());
  ++count;
  body.set_filter(with.filter);
  filters_pairs = filters_pairs || broad_filter(body) != BodyFilter{};
  body.importance = with.importance;
  body.suggest = with.suggest;
  body.continuous_speed = with.continuous_speed;
  if (with.continuous_speed > 0 && !any_continuous) {
    any_continuous = true;
    bodies.keep_before();
    go_by_origins();
  }
  body.min_reach = with.reach;
  for (const BodyPart& part : parts) {
    PartRecord& taken = body.parts.emplace_back();
    taken.shape = part.shape;
    detail::set_local(taken, shapes[part.shape], part.local);
  }
  bodies.parts_changed(id.index);
  body.since = answered + 1;
  body.reach = std::max(body.min_reach, detail::reach_of(body.parts));
  if (!any_continuous && !body.suggest && !(with.reach > 0)) detail::find_middle(body);
  changed(body);
  body.moved = -1;
  return body;
}

// A sweep goes by what origins do between steps, and not by middles, nor by where parts are at a step.
void Detector::State::go_by_origins() {
  while (part_search.any()) search_by_parts(part_search.bodies().front(), false);
  for (BodyIndex i = 0; i < bodies.slots(); ++i) {
    Body& body = bodies[i];
    if (body.id == kNoBody || body.is_static || !body.has_middle()) continue;
    detail::forget_middle(body);
    update_again(body);
  }
}

BodyId Detector::add_body(std::span<const BodyPart> parts, const BodyOptions& options) {
  State& s = *state_;
  if (!s.acceptable(parts) || !s.acceptable(options) || !s.bodies.has_source()) return kNoBody;
  return s.or_fail([&] {
    const BodyId id = s.broad.add(options.importance, options.filter);
    if (id == kNoBody) return id;
    s.take_in(id, parts, options);
    if (s.kept_states) s.kept_states->put(id.index, s.last_time(), {});
    if (s.watches) s.monitor.begin(id.index);
    s.halves.update_again(id.index);
    return id;
  });
}

BodyFilter Detector::State::broad_filter(const Body& body) noexcept {
  BodyFilter filter = body.filter();
  filter.ignores_static = filter.ignores_static || body.by_parts;
  return filter;
}

// It has rested up to the last step: where it was then is known.
void Detector::State::stir(Body& body) noexcept {
  if (body.frozen) body.asked = std::max(body.asked, answered);
  body.frozen = false;
}

Motion Detector::State::place_of(const Body& body) const noexcept {
  Motion place = bodies.motion_of(body.id.index, clock.time_step, body.has_middle());
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
    Body& body = s.take_in(id, parts, options);
    body.is_static = true;
    body.moved = s.answered + 1;
    s.bodies.state(id.index).pose = pose;
    s.bodies.moved(id.index, pose);
    s.halves.forget(id.index);
    if (s.broad.move_static(id, s.place_of(body))) {
      s.any_static = true;
      s.part_search.static_changed(id.index, s.bodies);
      return id;
    }
    remove(id);  // too large
    return kNoBody;
  });
}

BodyId Detector::add_half_space(const Vec3& normal, double offset, const BodyOptions& options) {
  State& s = *state_;
  const detail::ScaledVector scaled(normal);
  const double size = detail::length(Vec3(scaled.value)), height = std::ldexp(offset, scaled.power) / size;
  if (!s.valid || s.failed || s.stepping || !are_valid(options) || !(size > 0) || !(std::fabs(height) <= kMaxNumber))
    return kNoBody;
  Body body;
  body.set_filter(options.filter);
  body.importance = options.importance;
  body.since = s.answered + 1;
  return s.or_fail([&] {
    const BodyIndex index = s.halves.add({(1 / size) * Vec3(scaled.value), height}, body);
    s.halves.body(index).moved = s.answered + 1;
    s.halves.update_all(s.bodies.slots());
    ++s.count;
    return s.halves.body(index).id;
  });
}

// To change it.
Body* Detector::State::find(BodyId body) noexcept {
  if (stepping || !contains(body)) return nullptr;
  return is_half_space(body.index) ? &halves.body(body.index) : &bodies[body.index];
}

void Detector::State::update_again(Body& body) {
  if (is_half_space(body.id.index)) return;
  body.told_radius = -1;
  or_fail([&] {
    if (watches) monitor.cancelled(body.id.index);
    if (!body.is_static) halves.update_again(body.id.index);
    return broad.cancel(body.id);
  });
}

bool Detector::remove(BodyId body) {
  State& s = *state_;
  if (s.find(body) == nullptr) return false;
  --s.count;
  if (is_half_space(body.index)) return s.halves.remove(body.index);
  if (s.bodies[body.index].by_parts) s.part_search.end(body.index);
  if (s.bodies[body.index].is_static) s.part_search.static_gone(body.index);
  s.bodies.leave(body.index);
  return s.or_fail([&] {
    s.halves.forget(body.index);
    return s.broad.remove(body);
  });
}

bool Detector::cancel(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr) return false;
  state_->update_again(*found);
  return true;
}

bool Detector::teleport(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr || found->is_static) return false;
  found->frozen = false;
  found->asked = found->known_before = detail::kNotAsked;
  ++found->jumps;
  state_->any_jumped = true;
  state_->monitor.forget(body.index);
  state_->update_again(*found);
  return true;
}

bool Detector::move_static(BodyId body, const Pose& pose) {
  State& s = *state_;
  Body* found = s.find(body);
  if (found == nullptr || !found->is_static || is_half_space(body.index) || !is_rigid(pose)) return false;
  const Pose before = s.bodies.state(body.index).pose;
  s.bodies.state(body.index).pose = pose;
  if (!s.or_fail([&] { return s.broad.move_static(body, s.place_of(*found)); })) {
    s.bodies.state(body.index).pose = before;
    return false;
  }
  s.bodies.moved(body.index, before);
  s.changed(*found);
  return s.or_fail([&] {
    s.part_search.static_changed(body.index, s.bodies);
    return true;
  });
}

bool Detector::set_local(BodyId body, std::size_t part, const Pose& local) {
  State& s = *state_;
  Body* found = s.find(body);
  if (found == nullptr || part >= found->parts.size()) return false;
  const detail::PartRecord& record = found->parts[part];
  detail::PartPlace place;
  if (!detail::set_local(place, s.shapes[record.shape], local)) return false;
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
  if (s.any_continuous) {
    found->parts_before.resize(found->parts.size());
    detail::PartBefore& before = found->parts_before[part];
    if (before.until != s.answered) before = {record, s.answered};
  }
  s.bodies.move_part(body.index, part, place, s.shapes[record.shape]);
  s.changed(*found);
  if (stretches) found->stretched = s.answered;
  if (grows && !found->is_static) s.update_again(*found);
  if (!found->is_static) return true;
  return s.or_fail([&] {
    s.part_search.static_changed(body.index, s.bodies);
    return true;
  });
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
  state_->filters_pairs = true;
  if (is_half_space(body.index)) return true;
  return state_->or_fail([&] { return state_->broad.set_filter(body, State::broad_filter(*found)); });
}

bool Detector::sleep(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr || found->is_static) return false;
  if (found->asleep) return true;
  found->asleep = true;
  return state_->or_fail([&] {
    if (state_->kept_states) state_->keep(*found, state(body));
    state_->update_again(*found);
    return true;
  });
}

bool Detector::wake(BodyId body) {
  Body* found = state_->find(body);
  if (found == nullptr || found->is_static) return false;
  if (!found->asleep) return true;
  state_->stir(*found);
  found->asleep = false;
  state_->update_again(*found);
  return true;
}

bool Detector::asleep(BodyId body) const noexcept {
  return state_->contains(body) && state_->places.body(body.index).asleep;
}

bool Detector::shape_changed(ShapeId shape) {
  State& s = *state_;
  if (s.stepping || !s.shapes.contains(shape)) return false;
  s.shapes.changed(shape);
  for (BodyIndex i = 0; i < s.bodies.slots(); ++i) {
    Body& body = s.bodies[i];
    const auto uses = [shape](const PartRecord& part) { return part.shape == shape; };
    if (body.id != kNoBody && std::any_of(body.parts.begin(), body.parts.end(), uses)) {
      s.changed(body);
      s.bodies.deformed(i);
      ++body.deformed;
    }
  }
  return true;
}

void Detector::set_pair_filter(PairFilter filter) {
  State& s = *state_;
  if (s.stepping) return;
  ++s.filter_version;
  s.or_fail([&] {
    s.filter = filter;
    s.broad.set_pair_filter(std::move(filter));
    return true;
  });
}

}  // namespace orchard::runtime
