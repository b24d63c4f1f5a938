#include "broad_phase/body_pool.h"

#include <cassert>

namespace orchard::runtime::detail {

// First all that may throw, then the change.
BodyIndex BodyPool::add(std::uint8_t importance, const BodyFilter& filter, const Motion* place) {
  if (free_.empty() && slots() >= kMaxBodies) return kNoIndex;
  const bool again = !free_.empty();
  const BodyIndex body = again ? free_.back() : static_cast<BodyIndex>(slots());
  const std::size_t slots_then = std::max(slots(), std::size_t{body} + 1);
  make_class(importance);
  make_room(generations_, slots_then);
  make_room(importance_, slots_then);
  if (place != nullptr && free_slots_.empty()) make_room(static_motions_, static_motions_.size() + 1);
  if (place != nullptr || any_static()) make_room(static_slot_, slots_then);
  const bool filters = !filters_.empty() || filter != BodyFilter{};
  if (filters) make_room(filters_, slots_then);

  if (again) free_.pop_back();
  if (filters) {
    filters_.resize(slots_then);
    filters_[body] = filter;
  }
  generations_.resize(slots_then);
  importance_.resize(slots_then);
  if (place != nullptr || any_static()) static_slot_.resize(slots_then, kNoSlot);
  ++generations_[body];
  importance_[body] = importance;
  enter_class(importance);
  ++size_;
  if (place == nullptr) return body;
  if (free_slots_.empty()) {
    static_slot_[body] = static_cast<std::uint32_t>(static_motions_.size());
    static_motions_.emplace_back();
  } else {
    static_slot_[body] = free_slots_.back();
    free_slots_.pop_back();
  }
  move_static(body, *place);
  return body;
}

// What was taken from a list has room there; what was made new is the last one.
void BodyPool::undo_add(BodyIndex body) noexcept {
  if (is_static(body)) {
    const std::uint32_t slot = static_slot_[body];
    slot + 1 == static_motions_.size() ? static_motions_.pop_back() : free_slots_.push_back(slot);
    static_slot_[body] = kNoSlot;
  }
  leave_class(importance_[body]);
  --size_;
  if (--generations_[body] != 0) {
    free_.push_back(body);
    return;
  }
  assert(std::size_t{body} + 1 == slots());
  generations_.pop_back();
  importance_.pop_back();
  if (any_static()) static_slot_.pop_back();
  if (!filters_.empty()) filters_.pop_back();
}

void BodyPool::make_room_to_remove(BodyIndex body) {
  make_room(free_, free_.size() + 1);
  if (is_static(body)) make_room(free_slots_, free_slots_.size() + 1);
}

void BodyPool::remove(BodyIndex body) noexcept {
  assert(body < slots() && alive(body));
  // An index whose generations are used up is not used again.
  if (++generations_[body] != 0) free_.push_back(body);
  if (is_static(body)) {
    free_slots_.push_back(static_slot_[body]);
    static_slot_[body] = kNoSlot;
  }
  leave_class(importance_[body]);
  --size_;
  forget_motion_bound(body);
}

void BodyPool::move_static(BodyIndex body, const Motion& place) noexcept {
  Motion& stored = static_motions_[static_slot_[body]];
  stored = Motion{};
  stored.position = place.position;
  stored.radius = place.radius;
}

void BodyPool::set_importance(BodyIndex body, std::uint8_t importance) {
  make_class(importance);
  leave_class(importance_[body]);
  importance_[body] = importance;
  enter_class(importance);
}

unsigned BodyPool::next_class(unsigned from) const noexcept {
  while (from < in_class_.size() && in_class_[from] == 0) ++from;
  return from < in_class_.size() ? from : kNoClass;
}

void BodyPool::ask_all(Step step) {
  constexpr std::size_t kAtOnce = 64;
  std::array<BodyIndex, kAtOnce> bodies;
  std::array<Motion, kAtOnce> motions;
  std::size_t count = 0;
  const auto ask_them = [&] {
    if (count == 0) return;
    ask(step, std::span(bodies).first(count), std::span(motions).first(count));
    count = 0;
  };
  for (BodyIndex body = 0; body < slots(); ++body) {
    if (!alive(body) || is_static(body)) continue;
    bodies[count++] = body;
    if (count == kAtOnce) ask_them();
  }
  ask_them();
}

void BodyPool::ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
  asked_ += bodies.size();
  ask(step, bodies, motions, answers_);
}

void BodyPool::ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions, Answers& answers) {
  assert(bodies.size() == motions.size());
  if (any_static()) {
    ask_some(step, bodies, motions, answers);
  } else {
    source_(clock.time(step), bodies, motions);
  }
  for (std::size_t i = 0; check_ && i < bodies.size(); ++i) {
    if (!is_static(bodies[i])) check_->given(id_of(bodies[i]), motions[i], clock.time(step));
  }
}

// Those of them that move.
void BodyPool::ask_some(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions,
                        Answers& answers) const {
  answers.moving.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::uint32_t slot = static_slot_[bodies[i]];
    if (slot == kNoSlot) {
      answers.moving.push_back(bodies[i]);
    } else {
      motions[i] = static_motions_[slot];
    }
  }
  if (answers.moving.empty()) return;
  answers.motions.resize(answers.moving.size());
  source_(clock.time(step), answers.moving, answers.motions);
  for (std::size_t i = 0, next = 0; i < bodies.size(); ++i) {
    if (static_slot_[bodies[i]] == kNoSlot) motions[i] = answers.motions[next++];
  }
}

std::size_t BodyPool::memory_bytes() const noexcept {
  return bytes_of(in_class_, generations_, importance_, filters_, static_slot_, static_motions_, free_slots_, free_) +
         answers_.memory_bytes() + bytes_of(refused_) + (check_ ? sizeof(*check_) + check_->memory_bytes() : 0);
}

}  // namespace orchard::runtime::detail
