#pragma once
#include <array>

#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

inline constexpr Step kWheelSteps = 256;  // a power of two
inline constexpr Step kLongestWindow = kWheelSteps - 1;

// The rounds of window updates are counted modulo 2^kRoundBits. Rounds that are compared are less than half of that
// apart.
using Round = std::uint32_t;
inline constexpr unsigned kRoundBits = 31;
inline constexpr Round kFarthestRound = 1u << (kRoundBits - 2);
inline bool is_later(Round a, Round b) noexcept { return static_cast<std::int32_t>((a - b) << (32 - kRoundBits)) > 0; }

// An event of a pair: at its step, the pair is tested.
struct PairEvent {
  BodyPair pair;
  Round created : kRoundBits = 0;  // the event is void once one of the bodies has been updated in a later round
  Round parting : 1 = 0;           // the pair overlaps, and the event is for the step at which it can have parted

  PairEvent() = default;
  PairEvent(const BodyPair& of, Round round, bool parts = false) noexcept
      : pair(of), created(round & ((1u << kRoundBits) - 1)), parting(parts ? 1 : 0) {}
};
static_assert(sizeof(PairEvent) == 12);

// A ring of lists, indexed by step, of what is due in the next kWheelSteps - 1 steps: bodies whose windows have to be
// updated, and pairs to test. Entries may be void; the caller decides which ones are.
class TimingWheel {
 public:
  void set_due(std::span<const BodyIndex> bodies, Step step);
  void set_due(BodyIndex body, Step step);
  void clear_bodies() noexcept;
  void clear_events() noexcept;
  void clear() noexcept;  // removes everything and gives the memory back
  void add(const PairEvent& event, Step step);

  // Moves everything due at the step to the ends of the vectors.
  void take(Step step, std::vector<BodyIndex>& bodies, std::vector<PairEvent>& events);
  // Return how much take() would move, void entries included. bodies_due() costs O(its result).
  std::size_t bodies_due(Step step) const noexcept;
  std::size_t events_due(Step step) const noexcept {  // only of pairs that do not overlap yet
    return buckets_[bucket_of(step)].meetings;
  }
  // Returns whether a large share of the entries may be void, if there are so many bodies. Then tidy() pays.
  bool crowded(std::size_t bodies) const noexcept {
    constexpr std::size_t kBytesPerBody = 16;  // so few bytes do not matter
    return bytes_used() > std::max(kBytesPerBody * bodies, 2 * tidied_bytes_);
  }
  // Drops void entries after `now`: bodies for which end_of(body) is another step or that occur twice, and events for
  // which valid(event) is false. end_of(body) returns a reference, to which it writes meanwhile. Runs of bodies stay,
  // because they are short.
  template <typename EndOf, typename Valid>
  void tidy(Step now, const EndOf& end_of, const Valid& valid);
  // Returns the first step after `now` for which there may be entries; kNeverStep if there is none.
  Step next_after(Step now) const noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr BodyIndex kRun = kNoIndex - 1;  // marks bodies with successive indices, as all windows give
  struct Bodies {                                  // a part of a list; it is short, since a step may have one body only
    std::uint32_t next;
    // Up to three bodies, followed by kNoIndex. Or a run of bodies: the first one, kRun, and their number.
    std::array<BodyIndex, 3> ids;
  };
  static constexpr std::uint32_t kEventsInPart = 5;
  struct alignas(64) Events {  // a part of a list, one cache line; all parts but a list's first one are full
    std::array<PairEvent, kEventsInPart> events;
    std::uint32_t next;
  };
  static_assert(sizeof(Events) == 64);
  // A pool of parts of lists. Parts that a list gives back are used again.
  template <typename Part>
  struct Pool {
    std::vector<Part> parts;
    std::uint32_t free = kNone;
    std::size_t used = 0;

    Part& operator[](std::uint32_t part) noexcept { return parts[part]; }
    Part& put_before(std::uint32_t& head) {  // puts a part before the head of a list; the caller fills it in
      std::uint32_t part = free;
      ++used;
      if (part == kNone) {
        part = static_cast<std::uint32_t>(parts.size());
        grow(parts, parts.size() + 1);
      } else {
        free = parts[part].next;
      }
      parts[part].next = head;
      head = part;
      return parts[part];
    }
    std::uint32_t give_back(std::uint32_t part) noexcept {  // returns the next one
      const std::uint32_t next = std::exchange(parts[part].next, free);
      free = part;
      --used;
      return next;
    }
    void clear() noexcept { parts.clear(), free = kNone, used = 0; }
  };
  struct Bucket {
    std::uint32_t bodies = kNone, events = kNone;
    std::uint32_t in_first : 4 = kEventsInPart;  // the number of events in the first part; kEventsInPart if none exists
    std::uint32_t meetings : 28 = 0;             // the number of events of pairs that do not overlap yet
  };

  std::size_t bytes_used() const noexcept { return bodies_.used * sizeof(Bodies) + events_.used * sizeof(Events); }
  template <typename Use>
  void for_each_busy(const Use& use) noexcept;  // calls use(bucket)
  template <typename Use>
  static void for_each(const Bodies& some, const Use& use) {
    const bool run = some.ids[1] == kRun;
    const std::size_t count = run ? some.ids[2] : some.ids.size();
    for (std::size_t i = 0; i < count && (run || some.ids[i] != kNoIndex); ++i) {
      use(run ? some.ids[0] + static_cast<BodyIndex>(i) : some.ids[i]);
    }
  }
  static std::size_t bucket_of(Step step) noexcept { return static_cast<std::size_t>(step & (kWheelSteps - 1)); }
  void mark(std::size_t bucket) noexcept { busy_[bucket / 64] |= std::uint64_t{1} << (bucket % 64); }

  std::array<Bucket, kWheelSteps> buckets_{};
  std::array<std::uint64_t, kWheelSteps / 64> busy_{};  // a bit for each bucket that has entries, or has had some
  Pool<Bodies> bodies_;
  Pool<Events> events_;
  std::size_t tidied_bytes_ = 0;
};

template <typename EndOf, typename Valid>
void TimingWheel::tidy(Step now, const EndOf& end_of, const Valid& valid) {
  for (Step step = now + 1; step < now + kWheelSteps; ++step) {
    Bucket& bucket = buckets_[bucket_of(step)];
    const Bucket old = std::exchange(bucket, Bucket{});
    for (std::uint32_t part = old.bodies; part != kNone;) {
      const Bodies some = bodies_[part];
      part = bodies_.give_back(part);
      if (some.ids[1] == kRun) {
        bodies_.put_before(bucket.bodies).ids = some.ids;
        continue;
      }
      for_each(some, [&](BodyIndex body) {
        if (end_of(body) != step) return;
        end_of(body) = now;  // once is enough
        set_due(body, step);
      });
    }
    for (std::uint32_t part = bucket.bodies; part != kNone; part = bodies_[part].next) {
      if (bodies_[part].ids[1] != kRun) for_each(bodies_[part], [&](BodyIndex body) { end_of(body) = step; });
    }
    std::uint32_t count = old.in_first;
    for (std::uint32_t part = old.events; part != kNone; count = kEventsInPart) {
      const Events some = events_[part];
      part = events_.give_back(part);
      for (std::uint32_t i = 0; i < count; ++i) {
        if (valid(some.events[i])) add(some.events[i], step);
      }
    }
  }
  tidied_bytes_ = bytes_used();
}

}  // namespace orchard::runtime::detail
