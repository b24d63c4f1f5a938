#include "roster.h"

#include <cassert>

namespace orchard::runtime::detail {

BodyIndex Roster::add(std::uint8_t importance) {
  if (free_.empty() && slots() >= kMaxBodies) return kNoIndex;
  BodyIndex body;
  if (free_.empty()) {
    body = static_cast<BodyIndex>(generations_.size());
    grow(generations_, std::size_t{body} + 1);
    grow(importance_, std::size_t{body} + 1);
    if (!static_slot_.empty()) static_slot_.push_back(kNoSlot);
  } else {
    body = free_.back();
    free_.pop_back();
  }
  ++generations_[body];
  importance_[body] = importance;
  enter_class(importance);
  ++size_;
  return body;
}

void Roster::remove(BodyIndex body) {
  assert(body < slots() && alive(body));
  // An index whose generations are used up is not used again.
  if (++generations_[body] != 0) free_.push_back(body);
  if (is_static(body)) {
    free_slots_.push_back(static_slot_[body]);
    static_slot_[body] = kNoSlot;
  }
  leave_class(importance_[body]);
  --size_;
}

void Roster::set_static(BodyIndex body, const Motion& place) {
  if (static_slot_.empty()) static_slot_.assign(slots(), kNoSlot);
  std::uint32_t& slot = static_slot_[body];
  if (slot == kNoSlot) {
    if (free_slots_.empty()) {
      slot = static_cast<std::uint32_t>(static_motions_.size());
      static_motions_.emplace_back();
    } else {
      slot = free_slots_.back();
      free_slots_.pop_back();
    }
  }
  Motion& stored = static_motions_[slot];
  stored = Motion{};
  stored.position = place.position;
  stored.radius = place.radius;
}

void Roster::set_importance(BodyIndex body, std::uint8_t importance) {
  leave_class(importance_[body]);
  importance_[body] = importance;
  enter_class(importance);
}

unsigned Roster::next_class(unsigned from) const noexcept {
  while (from < in_class_.size() && in_class_[from] == 0) ++from;
  return from < in_class_.size() ? from : kNoClass;
}

void Roster::ask(Step step, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
  assert(bodies.size() == motions.size());
  asked_ += bodies.size();
  if (static_slot_.empty()) {
    source_(clock.time(step), bodies, motions);
    return;
  }
  moving_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const std::uint32_t slot = static_slot_[bodies[i]];
    if (slot == kNoSlot) {
      moving_.push_back(bodies[i]);
    } else {
      motions[i] = static_motions_[slot];
    }
  }
  if (moving_.empty()) return;
  answers_.resize(moving_.size());
  source_(clock.time(step), moving_, answers_);
  for (std::size_t i = 0, next = 0; i < bodies.size(); ++i) {
    if (static_slot_[bodies[i]] == kNoSlot) motions[i] = answers_[next++];
  }
}

std::size_t Roster::memory_bytes() const noexcept {
  return bytes_of(in_class_) + bytes_of(generations_) + bytes_of(importance_) + bytes_of(static_slot_) +
         bytes_of(static_motions_) + bytes_of(free_slots_) + bytes_of(free_) + bytes_of(moving_) + bytes_of(refused_) +
         bytes_of(answers_);
}

}  // namespace orchard::runtime::detail
