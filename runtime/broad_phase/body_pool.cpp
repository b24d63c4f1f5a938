#include "broad_phase/body_pool.h"

#include <array>
#include <cassert>

namespace orchard::runtime::detail {

void StaticBodies::add(BodyIndex body, std::size_t bodies, const Motion* place) noexcept {
  if (place != nullptr || any()) slots_.resize(bodies, kNoSlot);
  if (place == nullptr) return;
  if (free_.empty()) {
    slots_[body] = static_cast<std::uint32_t>(motions_.size());
    motions_.emplace_back();
  } else {
    slots_[body] = free_.back();
    free_.pop_back();
  }
  move(body, *place);
}

void StaticBodies::move(BodyIndex body, const Motion& place) noexcept {
  Motion& stored = motions_[slots_[body]];
  stored = Motion{};
  stored.position = place.position;
  stored.radius = place.radius;
}

void StaticBodies::remove(BodyIndex body) noexcept {
  if (!has(body)) return;
  free_.push_back(slots_[body]);
  slots_[body] = kNoSlot;
}

// All that may throw comes first, so that a failure changes nothing.
BodyIndex BodyPool::add(std::uint8_t importance, const BodyFilter& filter, const Motion* place) {
  if (free_.empty() && slots() >= kMaxBodies) return kNoIndex;
  const bool again = !free_.empty();
  const BodyIndex body = again ? free_.back() : static_cast<BodyIndex>(slots());
  const std::size_t slots_then = std::max(slots(), std::size_t{body} + 1);
  make_room(generations_, slots_then);
  make_room(free_, free_.size() + 1);
  classes.make_room(slots_then, importance);
  statics.make_room(slots_then, place != nullptr);
  const bool filtered = filters.any_of_bodies() || filter != BodyFilter{};
  if (filtered) filters.make_room(slots_then);

  if (again) free_.pop_back();
  if (filtered) filters.set(body, filter);
  generations_.resize(slots_then);
  ++generations_[body];
  classes.enter(body, importance);
  statics.add(body, slots_then, place);
  ++size_;
  return body;
}

void BodyPool::make_room_to_remove(BodyIndex body) {
  make_room(free_, free_.size() + 1);
  statics.make_room_to_remove(body);
}

void BodyPool::remove(BodyIndex body) noexcept {
  assert(body < slots() && alive(body));
  // An index whose generations are used up is not used again.
  if (++generations_[body] != 0) free_.push_back(body);
  statics.remove(body);
  classes.leave(body);
  --size_;
  motions.forget_bound(body);
}

void MotionQueries::ask_all(Step step) {
  constexpr std::size_t kAtOnce = 64;
  std::array<BodyIndex, kAtOnce> bodies;
  std::array<Motion, kAtOnce> motions;
  std::size_t count = 0;
  const auto ask_them = [&] {
    if (count == 0) return;
    ask(step, std::span(bodies).first(count), std::span(motions).first(count));
    count = 0;
  };
  for (BodyIndex body = 0; body < pool_.slots(); ++body) {
    if (!pool_.alive(body) || pool_.statics.has(body)) continue;
    bodies[count++] = body;
    if (count == kAtOnce) ask_them();
  }
  ask_them();
}

void MotionQueries::ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
  asked_ += bodies.size();
  ask(step, bodies, motions, answers_);
}

void MotionQueries::ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions, Answers& answers) {
  assert(bodies.size() == motions.size());
  if (pool_.statics.any()) {
    ask_some(step, bodies, motions, answers);
  } else {
    source_(pool_.clock.time(step), bodies, motions);
  }
  for (std::size_t i = 0; check_ && i < bodies.size(); ++i) {
    if (!pool_.statics.has(bodies[i])) check_->given(pool_.id_of(bodies[i]), motions[i], pool_.clock.time(step));
  }
}

// Asks the source for the motions of the bodies that move; those of static bodies are stored here.
void MotionQueries::ask_some(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions,
                             Answers& answers) const {
  answers.moving.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Motion* const place = pool_.statics.motion(bodies[i]);
    if (place == nullptr) {
      answers.moving.push_back(bodies[i]);
    } else {
      motions[i] = *place;
    }
  }
  if (answers.moving.empty()) return;
  answers.motions.resize(answers.moving.size());
  source_(pool_.clock.time(step), answers.moving, answers.motions);
  for (std::size_t i = 0, next = 0; i < bodies.size(); ++i) {
    if (pool_.statics.motion(bodies[i]) == nullptr) motions[i] = answers.motions[next++];
  }
}

std::size_t MotionQueries::memory_bytes() const noexcept {
  return answers_.memory_bytes() + bytes_of(refused_) + (check_ ? sizeof(*check_) + check_->memory_bytes() : 0);
}

std::size_t BodyPool::memory_bytes() const noexcept {
  return bytes_of(generations_, free_) + classes.memory_bytes() + statics.memory_bytes() + filters.memory_bytes() +
         motions.memory_bytes();
}

}  // namespace orchard::runtime::detail
