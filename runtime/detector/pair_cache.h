#pragma once
#include <array>
#include <cstddef>
#include <memory>

#include "detector/shape_placements.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime::detail {

// What is remembered of a pair that could not be skipped at some step, while it is one, or until its touch has ended.
// First what every loop over pairs reads.
struct CachedPair {
  BodyPair bodies{};
  BodyId a, b;
  struct Versions {              // of what it depends on, as seen last
    std::uint32_t filters = 0;   // changes of those of both bodies and of the application
    std::uint32_t jumps = 0;     // teleports of both bodies
    std::uint32_t deformed = 0;  // and changes of their shapes
    bool allowed = false;        // by these filters
  };
  Versions versions;
  struct Turn {                // within a budget
    std::uint32_t waited = 0;  // steps without a certain answer
    std::uint8_t importance = 0;
    std::uint8_t roots_wait = 0;  // steps for which the roots are not asked by themselves
  };
  Turn turn;
  std::uint32_t separated_steps = 0;  // certain ones in a row, while touching
  bool touching = false;
  bool coherent = false;  // one tree each: `trees` knows what the last answer was
  bool met = false;       // of several parts, these have met, and are trees: `trees` knows where
  struct Sweep {
    bool possible = false;  // at the step before both poses were known
    bool unseen = false;    // there is no pose of the previous step, so no sweep is possible
    bool impact = false;    // found one, from here to there in the step
    double impact_from = 0, impact_to = 0;
  };
  Sweep sweep;
  Step answered = -1;  // the step of `verdict`, if that is certain
  std::array<std::uint32_t, 2> parts{};
  Verdict verdict;
  Vec3 apart_along{};  // of the answer of the step under way, if that is "no": Clearance::along
  TreePair trees;
};

// How two bodies are to each other at some step: their middles are this way from each other, but for `slack`, and they
// have turned so far; see BoundingSphereCache.
struct RelativePlacement {
  double slack = 0;
  Vec3 way{};
  double turned = 0;
  std::uint32_t changes = 0;
};

// Of a vector rounded to floats, in its length, and of a unit vector besides, which is one to within half of that.
inline constexpr double kRoundedToFloat = 4e-7;

// A certain "no" that lasts: the two were `distance` apart, at least, when they stood like that. What their places are
// rounded by to floats has been taken from it.
struct Clearance {
  using Floats = std::array<float, 3>;
  double distance = 0;  // 0: none
  double turned = 0;
  Floats way{};
  Floats along{};  // the direction from the first one to the second one in which they were that far apart, or 0
  std::uint32_t changes = 0;
};

inline constexpr std::uint32_t kNoRecord = 0x7fffffffu;

// The pairs of the step before, in ascending order, what is known of each, and the records of some.
class PairCache {
 public:
  struct Known {  // no larger than a line of memory: most pairs of a step are asked no more than this, if that
    BodyPair pair;
    std::uint32_t record;       // or kNoRecord
    std::uint32_t generations;  // of both bodies: others have others
    Clearance clearance;
  };

  std::size_t size() const noexcept { return pairs_.size(); }
  bool empty() const noexcept { return pairs_.empty(); }
  std::span<const std::uint32_t> kept() const noexcept { return kept_places_; }  // those that match() was not given
  // By place, in ascending order.
  const BodyPair& pair(std::size_t place) const noexcept { return pairs_[place]; }
  Known& known(std::size_t place) noexcept { return known_[slots_[place] & kSlot]; }
  const Known& known(std::size_t place) const noexcept { return known_[slots_[place] & kSlot]; }
  // Whether a certain "no" would change its record, or its end would be noticed.
  bool busy(std::size_t place) const noexcept { return (slots_[place] & kBusy) != 0; }
  void tell(std::size_t place, bool busy) noexcept { slots_[place] = (slots_[place] & kSlot) | (busy ? kBusy : 0); }
  ORCHARD_INLINE void prefetch_known(std::size_t place) const noexcept { prefetch(&known(place)); }

  CachedPair& operator[](std::uint32_t record) noexcept { return *records_[record]; }
  const CachedPair& operator[](std::uint32_t record) const noexcept { return *records_[record]; }
  void take(std::size_t place);  // a new record for known(place)

  // The known ones are these from now on, which ascend. Asks same(place) of each that has been one, whether it is the
  // same pair still. Calls gone(known) for each busy one that is not among them, or not the same, and keeps the former
  // if that says true; generations(pair) for each that is new.
  template <typename IsSame, typename Gone, typename Generations>
  void match(std::span<const BodyPair> pairs, IsSame&& same, Gone&& gone, Generations&& generations);
  std::size_t memory_bytes() const noexcept {
    return records_.size() * sizeof(CachedPair) +
           bytes_of(records_, free_, known_, free_slots_, pairs_, slots_, next_pairs_, next_slots_, kept_places_);
  }

 private:
  void keep(std::size_t from, std::size_t count);
  void add(const BodyPair& pair, std::uint32_t generations);
  void leave(std::size_t place) noexcept;

  std::vector<std::unique_ptr<CachedPair>> records_;  // in use, or free
  std::vector<std::uint32_t> free_;
  std::vector<Known> known_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<BodyPair> pairs_, next_pairs_;
  static constexpr std::uint32_t kBusy = 0x80000000u, kSlot = kBusy - 1;
  std::vector<std::uint32_t> slots_, next_slots_;  // of known_, and flags
  std::vector<std::uint32_t> kept_places_;
};

template <typename IsSame, typename Gone, typename Generations>
void PairCache::match(std::span<const BodyPair> pairs, IsSame&& same, Gone&& gone, Generations&& generations) {
  next_pairs_.clear(), next_slots_.clear(), kept_places_.clear();
  const std::size_t had = pairs_.size();
  for (std::size_t old = 0, now = 0; old < had || now < pairs.size();) {
    const std::size_t most = std::min(had - old, pairs.size() - now);
    std::size_t alike = 0;  // most of them are, from one step to the next
    while (alike < most && pairs_[old + alike] == pairs[now + alike] && same(old + alike)) ++alike;
    keep(old, alike);
    old += alike, now += alike;
    const bool is_known = old < had && now < pairs.size() && pairs_[old] == pairs[now];
    if (now < pairs.size() && (old == had || is_known || pairs[now] < pairs_[old])) {
      if (is_known) {  // of a body that is no more: it cannot stay
        if (busy(old)) gone(known(old));
        leave(old++);
      }
      add(pairs[now], generations(pairs[now]));
      ++now;
    } else if (old < had && busy(old) && gone(known(old))) {
      kept_places_.push_back(static_cast<std::uint32_t>(next_pairs_.size()));
      keep(old++, 1);
    } else if (old < had) {
      leave(old++);
    }
  }
  pairs_.swap(next_pairs_), slots_.swap(next_slots_);
}

}  // namespace orchard::runtime::detail
