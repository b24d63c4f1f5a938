#include "broad_phase/timing_wheel.h"

#include <bit>
#include <cassert>

namespace orchard::runtime::detail {
void TimingWheel::set_due(std::span<const BodyIndex> bodies, Step step) {
  constexpr std::size_t kMinRun = 8;
  const std::size_t bucket = bucket_of(step);
  std::uint32_t& head = buckets_[bucket].bodies;
  mark(bucket);
  if (bodies.size() >= kMinRun && successive(bodies)) {
    return add_line(head, {bodies[0], kRun, static_cast<BodyIndex>(bodies.size())});
  }
  std::size_t done = 0;
  if (head != kNone) {  // what its last part has room for
    for (BodyIndex& id : lines_[head].ids) {
      if (id == kNoIndex && done < bodies.size()) id = bodies[done++];
    }
  }
  for (; done < bodies.size(); done += 3) {
    const auto at = [&](std::size_t i) { return i < bodies.size() ? bodies[i] : kNoIndex; };
    add_line(head, {at(done), at(done + 1), at(done + 2)});
  }
}

void TimingWheel::set_due(BodyIndex body, Step step) {
  const std::size_t bucket = bucket_of(step);
  std::uint32_t& head = buckets_[bucket].bodies;
  mark(bucket);
  const std::size_t room =
      head == kNone ? 3
                    : static_cast<std::size_t>(std::count_if(lines_[head].ids.begin(), lines_[head].ids.end(),
                                                             [](BodyIndex id) { return id != kNoIndex; }));
  if (room < 3) {
    lines_[head].ids[room] = body;
  } else {
    add_line(head, {body, kNoIndex, kNoIndex});
  }
}

void TimingWheel::add_line(std::uint32_t& head, const std::array<BodyIndex, 3>& ids) {
  std::uint32_t line = free_line_;
  if (line == kNone) {
    line = static_cast<std::uint32_t>(lines_.size());
    grow(lines_, lines_.size() + 1);
  } else {
    free_line_ = lines_[line].next;
  }
  lines_[line] = {head, ids};
  head = line;
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
  lines_.clear();
  free_line_ = kNone;
}

void TimingWheel::clear_events() noexcept {
  for_each_busy([](Bucket& bucket) { bucket.events = kNone, bucket.in_first = kEventsInPart, bucket.meetings = 0; });
  parts_.clear();
  free_part_ = kNone;
}

void TimingWheel::clear() noexcept {
  buckets_.fill({});
  busy_.fill(0);
  give_back(lines_);
  give_back(parts_);
  free_line_ = free_part_ = kNone;
}

void TimingWheel::add_part(Bucket& bucket) {
  std::uint32_t part = free_part_;
  if (part == kNone) {
    part = static_cast<std::uint32_t>(parts_.size());
    grow(parts_, parts_.size() + 1);
  } else {
    free_part_ = parts_[part].next;
  }
  parts_[part].next = bucket.events;
  bucket.events = part;
  bucket.in_first = 0;
}

void TimingWheel::add(const PairEvent& event, Step step) {
  const std::size_t index = bucket_of(step);
  Bucket& bucket = buckets_[index];
  if (bucket.in_first == kEventsInPart) add_part(bucket);
  parts_[bucket.events].events[bucket.in_first++] = event;
  if (event.parting == 0) ++bucket.meetings;
  mark(index);
}

void TimingWheel::take(Step step, std::vector<BodyIndex>& bodies, std::vector<PairEvent>& events) {
  const std::size_t index = bucket_of(step);
  Bucket& bucket = buckets_[index];
  for (std::uint32_t line = bucket.bodies; line != kNone;) {
    Bodies& part = lines_[line];
    if (part.ids[1] == kRun) {
      for (BodyIndex i = 0; i < part.ids[2]; ++i) bodies.push_back(part.ids[0] + i);
    } else {
      for (const BodyIndex body : part.ids) {
        if (body != kNoIndex) bodies.push_back(body);
      }
    }
    const std::uint32_t next = part.next;
    part.next = free_line_;
    free_line_ = line;
    line = next;
  }
  std::uint32_t count = bucket.in_first;
  for (std::uint32_t part = bucket.events; part != kNone; count = kEventsInPart) {  // the last one added comes first
    KineticBroadPhase& some = parts_[part];
    const std::uint32_t next = some.next;
    if (next != kNone) prefetch(&parts_[next]);
    while (count > 0) append(events, some.events[--count]);
    some.next = free_part_;
    free_part_ = part;
    part = next;
  }
  bucket = Bucket{};
  busy_[index / 64] &= ~(std::uint64_t{1} << (index % 64));
}

std::size_t TimingWheel::bodies_due(Step step) const noexcept {
  std::size_t count = 0;
  for (std::uint32_t line = buckets_[bucket_of(step)].bodies; line != kNone; line = lines_[line].next) {
    const std::array<BodyIndex, 3>& ids = lines_[line].ids;
    if (ids[1] == kRun) {
      count += ids[2];
    } else {
      for (const BodyIndex body : ids) count += body != kNoIndex;
    }
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

std::size_t TimingWheel::memory_bytes() const noexcept { return sizeof(*this) + bytes_of(lines_) + bytes_of(parts_); }

}  // namespace orchard::runtime::detail
