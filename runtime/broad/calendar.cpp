#include "calendar.h"

#include <bit>
#include <cassert>

namespace orchard::runtime::detail {

void Calendar::make_room(std::size_t bodies) { grow(links_, bodies); }

void Calendar::set_due(BodyId body, Step step) noexcept {
  clear_due(body);
  const std::size_t bucket = bucket_of(step);
  std::uint32_t& head = buckets_[bucket].body;
  links_[body] = {head, static_cast<std::uint32_t>(bucket) | kHeadBit};
  if (head != kNone) links_[head].previous = body;
  head = body;
  mark(bucket);
}

void Calendar::clear_due(BodyId body) noexcept {
  Links& own = links_[body];
  if (own.previous == kNone) return;
  std::uint32_t& before = own.previous & kHeadBit ? buckets_[own.previous & ~kHeadBit].body : links_[own.previous].next;
  before = own.next;
  if (own.next != kNone) links_[own.next].previous = own.previous;
  own = Links{};
}

void Calendar::clear_all_due() noexcept {
  for (Bucket& bucket : buckets_) bucket.body = kNone;
  for (Links& links : links_) links = Links{};
}

void Calendar::add(const PairEvent& event, Step step) {
  const std::size_t bucket = bucket_of(step);
  std::uint32_t node = free_node_;
  if (node == kNone) {
    node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
  } else {
    free_node_ = nodes_[node].next;
  }
  nodes_[node] = {event, buckets_[bucket].event};
  buckets_[bucket].event = node;
  mark(bucket);
}

void Calendar::take(Step step, std::vector<BodyId>& bodies, std::vector<PairEvent>& events) {
  const std::size_t index = bucket_of(step);
  Bucket& bucket = buckets_[index];
  for (std::uint32_t body = bucket.body; body != kNone;) {
    bodies.push_back(body);
    const std::uint32_t next = links_[body].next;
    links_[body] = Links{};
    body = next;
  }
  for (std::uint32_t node = bucket.event; node != kNone;) {
    events.push_back(nodes_[node].event);
    const std::uint32_t next = nodes_[node].next;
    nodes_[node].next = free_node_;
    free_node_ = node;
    node = next;
  }
  bucket = Bucket{};
  busy_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
}

Step Calendar::next_after(Step now) const noexcept {
  for (Step ahead = 1; ahead < kCalendarSteps;) {
    const std::size_t bucket = bucket_of(now + ahead);
    const std::uint64_t rest = busy_[bucket / 64] >> (bucket % 64);
    if (rest != 0) {
      ahead += std::countr_zero(rest);
      return ahead < kCalendarSteps ? now + ahead : kNeverStep;
    }
    ahead += static_cast<Step>(64 - bucket % 64);
  }
  return kNeverStep;
}

std::size_t Calendar::memory_bytes() const noexcept { return sizeof(*this) + bytes_of(links_) + bytes_of(nodes_); }

}  // namespace orchard::runtime::detail
