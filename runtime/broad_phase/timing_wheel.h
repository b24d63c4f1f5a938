#pragma once
#include <array>

#include "broad_phase/body_pool.h"

namespace orchard::runtime::detail {

inline constexpr Step kWheelSteps = 256;  // a power of two
inline constexpr Step kLongestWindow = kWheelSteps - 1;

// Rounds of updates are counted modulo 2^kRoundBits. Those compared are never as far apart as half of that.
using Round = std::uint32_t;
inline constexpr unsigned kRoundBits = 31;
inline constexpr Round kFarthestRound = 1u << (kRoundBits - 2);
inline bool is_later(Round a, Round b) noexcept { return static_cast<std::int32_t>((a - b) << (32 - kRoundBits)) > 0; }

struct PairEvent {
  BodyPair pair;
  Round created : kRoundBits = 0;  // void once either body has been updated in a later round
  Round parting : 1 = 0;           // the pair is among those that overlap

  PairEvent() = default;
  PairEvent(const BodyPair& of, Round round, bool parts = false) noexcept
      : pair(of), created(round & ((1u << kRoundBits) - 1)), parting(parts ? 1 : 0) {}
};
static_assert(sizeof(PairEvent) == 12);

// What is due when, for less than kWheelSteps steps ahead: bodies to update again and pairs to test, in a ring of
// lists indexed by step. The caller tells what is void.
class TimingWheel {
 public:
  void set_due(std::span<const BodyIndex> bodies, Step step);
  void set_due(BodyIndex body, Step step);
  void clear_bodies() noexcept;
  void clear_events() noexcept;
  void clear() noexcept;  // of everything, its memory, too
  void add(const PairEvent& event, Step step);

  // Moves everything due at the step to the ends of the vectors.
  void take(Step step, std::vector<BodyIndex>& bodies, std::vector<PairEvent>& events);
  // How much take() would give, void entries included.
  std::size_t bodies_due(Step step) const noexcept;   // O(of that)
  std::size_t events_due(Step step) const noexcept {  // of pairs that do not overlap yet
    return buckets_[bucket_of(step)].meetings;
  }
  // Whether void entries may be much of it, with so many bodies.
  bool crowded(std::size_t bodies) const noexcept {
    constexpr std::size_t kBytesPerBody = 8;  // that do not matter
    return bytes_used() > std::max(kBytesPerBody * bodies, tidied_bytes_ + tidied_bytes_ / 2);
  }
  // Drops void entries after `now`: bodies for which end_of(body), which it may write to meanwhile, is another step, or
  // which are there twice, and events that are not valid(). Runs stay: they are short.
  template <typename EndOf, typename Valid>
  void tidy(Step now, const EndOf& end_of, const Valid& valid);
  // The first step after `now` that may have something; kNeverStep if there is none.
  Step next_after(Step now) const noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr BodyIndex kRun = kNoIndex - 1;  // bodies with successive indices, as in updates of all windows
  struct Bodies {                                  // a part of a list: short, as a step may have one body only
    std::uint32_t next;
    // kNoIndex from the first one that is missing; or a run: its first one, kRun, how many.
    std::array<BodyIndex, 3> ids;
  };
  static constexpr std::uint32_t kEventsInPart = 5;
  struct alignas(64) Events {  // a part of a list, one cache line; all parts but a list's first one are full
    std::array<PairEvent, kEventsInPart> events;
    std::uint32_t next;
  };
  static_assert(sizeof(Events) == 64);
  // Parts of lists. What a list gives back is used again.
  template <typename Part>
  struct Pool {
    std::vector<Part> parts;
    std::uint32_t free = kNone;
    std::size_t used = 0;

    Part& operator[](std::uint32_t part) noexcept { return parts[part]; }
    Part& put_before(std::uint32_t& head) {  // of a list, a part that is written now
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
    std::uint32_t in_first : 4 = kEventsInPart;  // events in the first part; as if full where there is none
    std::uint32_t meetings : 28 = 0;             // events of pairs that do not overlap yet
  };

  std::size_t bytes_used() const noexcept { return bodies_.used * sizeof(Bodies) + events_.used * sizeof(Events); }
  template <typename Use>
  void for_each_busy(const Use& use) noexcept;  // bucket
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
  std::array<std::uint64_t, kWheelSteps / 64> busy_{};  // a bit per bucket with anything in it, or once had
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
