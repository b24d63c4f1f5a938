#include "broad_phase/backlog.h"

namespace orchard::runtime::detail {

Backlog::Rank& Backlog::rank(unsigned importance) {
  if (ranks_.size() <= importance) ranks_.resize(std::size_t{importance} + 1);
  return ranks_[importance];
}

void Backlog::wait(BodyIndex body, std::uint8_t importance) {
  if (waits(body)) return;
  if (waits_in_.size() <= body) waits_in_.resize(std::size_t{body} + 1, kNoWhere);
  Rank& to = rank(importance);
  to.updates.tidy([&](BodyIndex other) { return waits_in_[other] == importance; });
  to.updates.push(body);
  waits_in_[body] = importance;
  ++to.bodies;
}

void Backlog::leave(BodyIndex body) noexcept {
  if (!waits(body)) return;
  --ranks_[waits_in_[body]].bodies;
  waits_in_[body] = kNoWhere;
}

std::size_t Backlog::take(unsigned importance, std::span<BodyIndex> bodies) noexcept {
  Rank& from = ranks_[importance];
  std::size_t count = 0;
  while (count < bodies.size() && !from.updates.empty()) {
    const BodyIndex body = from.updates.pop();
    if (waits_in_[body] != importance) continue;
    leave(body);
    bodies[count++] = body;
  }
  return count;
}

void Backlog::take_all(std::vector<BodyIndex>& bodies, std::vector<PairEvent>& pairs) {
  for (unsigned importance = 0; importance < ranks_.size(); ++importance) {
    Rank& rank = ranks_[importance];
    make_room(bodies, bodies.size() + rank.bodies);
    for (BodyIndex body; take(importance, {&body, 1}) > 0;) bodies.push_back(body);
    rank.found.move_to(pairs);
    rank.due.move_to(pairs);
    rank.lead = 0;
  }
}

void Backlog::append_bodies(std::vector<BodyIndex>& bodies) const {
  for (BodyIndex body = 0; body < waits_in_.size(); ++body) {
    if (waits(body)) bodies.push_back(body);
  }
}

std::size_t Backlog::size() const noexcept {
  std::size_t all = 0;
  for (const Rank& rank : ranks_) all += rank.bodies + rank.found.size() + rank.due.size();
  return all;
}

bool Backlog::no_body_waits() const noexcept {
  return std::all_of(ranks_.begin(), ranks_.end(), [](const Rank& rank) { return rank.bodies == 0; });
}

std::size_t Backlog::memory_bytes() const noexcept {
  std::size_t bytes = ranks_.size() * sizeof(Rank) + bytes_of(waits_in_);
  for (const Rank& rank : ranks_)
    bytes += rank.updates.memory_bytes() + rank.found.memory_bytes() + rank.due.memory_bytes();
  return bytes;
}

}  // namespace orchard::runtime::detail
