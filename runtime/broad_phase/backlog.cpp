#include "broad_phase/backlog.h"

namespace orchard::runtime::detail {

PairEvent PairQueue::pop() noexcept {
  const PairEvent event = pairs_[first_++];
  if (first_ == pairs_.size()) {
    pairs_.clear();
    first_ = 0;
  } else if (2 * first_ > pairs_.size()) {
    pairs_.erase(pairs_.begin(), pairs_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
  return event;
}

void PairQueue::move_to(std::vector<PairEvent>& pairs) {
  pairs.insert(pairs.end(), pairs_.begin() + static_cast<std::ptrdiff_t>(first_), pairs_.end());
  pairs_.clear();
  first_ = tidied_ = 0;
}

Backlog::Rank& Backlog::rank(unsigned importance) {
  if (ranks_.size() <= importance) ranks_.resize(std::size_t{importance} + 1);
  return ranks_[importance];
}

void Backlog::wait(BodyIndex body, std::uint8_t importance) {
  if (waits(body)) return;
  grow(links_, std::size_t{body} + 1);
  Rank& to = rank(importance);
  links_[body] = {kNoIndex, to.last, importance, true};
  (to.last == kNoIndex ? to.first : links_[to.last].next) = body;
  to.last = body;
  ++to.bodies;
}

void Backlog::leave(BodyIndex body) noexcept {
  if (!waits(body)) return;
  Link& link = links_[body];
  Rank& from = ranks_[link.importance];
  (link.before == kNoIndex ? from.first : links_[link.before].next) = link.next;
  (link.next == kNoIndex ? from.last : links_[link.next].before) = link.before;
  --from.bodies;
  link = Link{};
}

std::size_t Backlog::take(unsigned importance, std::span<BodyIndex> bodies) noexcept {
  const Rank& from = ranks_[importance];
  std::size_t count = 0;
  while (count < bodies.size() && from.first != kNoIndex) {
    bodies[count] = from.first;
    leave(bodies[count++]);
  }
  return count;
}

void Backlog::take_all(std::vector<BodyIndex>& bodies, std::vector<PairEvent>& pairs) {
  for (Rank& rank : ranks_) {
    while (rank.first != kNoIndex) {
      bodies.push_back(rank.first);
      leave(rank.first);
    }
    rank.found.move_to(pairs);
    rank.due.move_to(pairs);
    rank.lead = 0;
  }
}

void Backlog::append_bodies(std::vector<BodyIndex>& bodies) const {
  for (const Rank& rank : ranks_) {
    for (BodyIndex body = rank.first; body != kNoIndex; body = links_[body].next) bodies.push_back(body);
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
  std::size_t bytes = ranks_.size() * sizeof(Rank) + bytes_of(links_);
  for (const Rank& rank : ranks_) bytes += rank.found.memory_bytes() + rank.due.memory_bytes();
  return bytes;
}

}  // namespace orchard::runtime::detail
