#include "broad_phase/timing_wheel.h"

#include <bit>
#include <cassert>

namespace orchard::runtime::detail {

void TimingWheel::set_due(std::span<const BodyIndex> bodies, Step step) {
  constexpr std::size_t kMinRun = 8;
  if (bodies.size() < kMinRun || !successive(bodies)) {
    for (const BodyIndex body : bodies) set_due(body, step);
    return;
  }
  mark(bucket_of(step));
  bodies_.put_before(buckets_[bucket_of(step)].bodies).ids = {bodies[0], kRun, static_cast<BodyIndex>(bodies.size())};
}

void TimingWheel::set_due(BodyIndex body, Step step) {
  std::uint32_t& head = buckets_[bucket_of(step)].bodies;
  if (head != kNone) {  // the first part may have room
    for (BodyIndex& id : bodies_[head].ids) {
      if (id == kNoIndex) return void(id = body);
    }
  }
  mark(bucket_of(step));
  bodies_.put_before(head).ids = {body, kNoIndex, kNoIndex};
}

template <typename Use>
void TimingWheel::for_each_busy(const Use& use) noexcept {
  for (std::size_t word = 0; word < busy_.size(); ++word) {
    for (std::uint64_t bits = busy_[word]; bits != 0; bits &= bits - 1) {
      use(buckets_[64 * word + static_cast<std::size_t>(std::countr_zero(bits))]);
    }
  }
}

void TimingWheel::clear_bodies() noexcept {
  for_each_busy([](Bucket& bucket) { bucket.bodies = kNone; });
  bodies_.clear();
}

void TimingWheel::clear_events() noexcept {
  for_each_busy([](Bucket& bucket) { bucket = {.bodies = bucket.bodies}; });
  events_.clear();
}

void TimingWheel::clear() noexcept {
  buckets_.fill({});
  busy_.fill(0);
  bodies_ = {};
  events_ = {};
}

void TimingWheel::add(const PairEvent& event, Step step) {
  const std::size_t index = bucket_of(step);
  Bucket& bucket = buckets_[index];
  if (bucket.in_first == kEventsInPart) {
    events_.put_before(bucket.events);
    bucket.in_first = 0;
  }
  events_[bucket.events].events[bucket.in_first++] = event;
  if (event.parting == 0) ++bucket.meetings;
  mark(index);
}

void TimingWheel::take(Step step, std::vector<BodyIndex>& bodies, std::vector<PairEvent>& events) {
  const std::size_t index = bucket_of(step);
  Bucket& bucket = buckets_[index];
  for (std::uint32_t part = bucket.bodies; part != kNone; part = bodies_.give_back(part)) {
    for_each(bodies_[part], [&](BodyIndex body) { bodies.push_back(body); });
  }
  std::uint32_t count = bucket.in_first;
  for (std::uint32_t part = bucket.events; part != kNone; count = kEventsInPart) {  // the last one added comes first
    const Events& some = events_[part];
    if (some.next != kNone) prefetch(&events_[some.next]);
    make_room(events, events.size() + count);
    events.insert(events.end(), std::make_reverse_iterator(some.events.begin() + count), some.events.rend());
    part = events_.give_back(part);
  }
  bucket = Bucket{};
  busy_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
}

std::size_t TimingWheel::bodies_due(Step step) const noexcept {
  std::size_t count = 0;
  for (std::uint32_t part = buckets_[bucket_of(step)].bodies; part != kNone; part = bodies_.parts[part].next) {
    for_each(bodies_.parts[part], [&](BodyIndex) { ++count; });
  }
  return count;
}

Step TimingWheel::next_after(Step now) const noexcept {
  for (Step ahead = 1; ahead < kWheelSteps;) {
    const std::size_t bucket = bucket_of(now + ahead);
    const std::uint64_t rest = busy_[bucket / 64] >> (bucket % 64);
    if (rest != 0) {
      ahead += std::countr_zero(rest);
      return ahead < kWheelSteps ? now + ahead : kNeverStep;
    }
    ahead += static_cast<Step>(64 - bucket % 64);
  }
  return kNeverStep;
}

std::size_t TimingWheel::memory_bytes() const noexcept {
  return sizeof(*this) + bytes_of(bodies_.parts, events_.parts);
}

}  // namespace orchard::runtime::detail
