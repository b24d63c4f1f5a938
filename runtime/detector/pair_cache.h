#pragma once
#include <array>
#include <cstddef>
#include <memory>

#include "detector/shape_placements.h"
#include "orchard/runtime/collide.h"

namespace orchard::runtime::detail {

// The record of a pair: what is remembered of it from step to step. A pair gets a record at the first step that cannot
// skip it, and keeps it while it is a pair or touches. The members that every loop over pairs reads come first.
struct CachedPair {
  BodyPair bodies{};
  BodyId a, b;
  struct Versions {              // counts of the changes that the answer depends on, as seen last
    std::uint32_t filters = 0;   // changes of the filters of both bodies and of the application
    std::uint32_t jumps = 0;     // teleports of both bodies
    std::uint32_t deformed = 0;  // changes of the shapes of both bodies
    bool allowed = false;        // whether these filters allow the pair
  };
  Versions versions;
  struct Turn {                // for the schedule within a budget
    std::uint32_t waited = 0;  // the number of successive steps without a certain answer
    std::uint8_t importance = 0;
    std::uint8_t roots_wait = 0;  // for so many further steps, the roots are not tested before a search
  };
  Turn turn;
  std::uint32_t separated_steps = 0;  // the number of successive steps with a certain "no", while `touching`
  bool touching = false;
  bool coherent = false;  // both bodies have one part, a tree, and `trees` remembers the last answer
  bool met = false;       // with several parts: two that are trees have touched, and `trees` remembers where
  struct Sweep {
    bool possible = false;  // a body is continuous, and both poses at the step before are known
    bool unseen = false;    // there is no pose of the previous step, so no sweep is possible
    bool impact = false;    // an impact was found between these two fractions of the step
    double impact_from = 0, impact_to = 0;
  };
  Sweep sweep;
  Step answered = -1;                    // the last step with a certain answer, or -1 if there is none to rely on
  std::array<std::uint32_t, 2> parts{};  // the parts that `verdict` is about
  Verdict verdict;
  Vec3 apart_along{};  // Clearance::along of this step's answer, if that is "no"
  TreePair trees;
};

// The placement of one body relative to another at some step. All but `way` are sums of the members of
// BoundingSphereCache with the same names; half-spaces add nothing.
struct RelativePlacement {
  double slack = 0;
  Vec3 way{};  // from the centre of the first body to that of the second, with an error of at most `slack`
  double turned = 0;
  std::uint32_t changes = 0;
};

// A bound on the error of a vector that is rounded to floats, as a fraction of its length. For a unit vector, it also
// allows for a length that is off by half as much.
inline constexpr double kRoundedToFloat = 4e-7;

// A certain "no" that later steps can rely on. The bodies were at least `distance` apart in the placement that the
// other members describe. The error of rounding that placement to floats has been subtracted from `distance`.
struct Clearance {
  using Floats = std::array<float, 3>;
  double distance = 0;  // 0: there is no such answer
  double turned = 0;
  Floats way{};
  Floats along{};  // the direction, from the first body to the second, in which they were that far apart; 0 if unknown
  std::uint32_t changes = 0;
};

inline constexpr std::uint32_t kNoRecord = 0x7fffffffu;

// The pairs of the last step in ascending order, a short entry (Known) for each, and a record (CachedPair) for some.
// The place of a pair is its number in that order.
class PairCache {
 public:
  struct Known {  // no larger than a cache line: for most pairs, a step reads at most this
    BodyPair pair;
    std::uint32_t record;       // the index of the record, or kNoRecord
    std::uint32_t generations;  // the sum for both bodies; it differs if an index belongs to another body now
    Clearance clearance;
  };

  std::size_t size() const noexcept { return pairs_.size(); }
  bool empty() const noexcept { return pairs_.empty(); }
  // The places, in ascending order, of the pairs that match() kept although it was not given them.
  std::span<const std::uint32_t> kept() const noexcept { return kept_places_; }
  // The pair at a place, and its entry.
  const BodyPair& pair(std::size_t place) const noexcept { return pairs_[place]; }
  Known& known(std::size_t place) noexcept { return known_[slots_[place] & kSlot]; }
  const Known& known(std::size_t place) const noexcept { return known_[slots_[place] & kSlot]; }
  // Returns whether a certain "no" would change the record of the pair, or its end has to be reported. Both are so if
  // the pair touches, or if its last answer was not certain.
  bool busy(std::size_t place) const noexcept { return (slots_[place] & kBusy) != 0; }
  // Sets what busy() returns.
  void tell(std::size_t place, bool busy) noexcept { slots_[place] = (slots_[place] & kSlot) | (busy ? kBusy : 0); }
  ORCHARD_INLINE void prefetch_known(std::size_t place) const noexcept { prefetch(&known(place)); }

  CachedPair& operator[](std::uint32_t record) noexcept { return *records_[record]; }
  const CachedPair& operator[](std::uint32_t record) const noexcept { return *records_[record]; }
  void take(std::size_t place);  // gives known(place) a new record

  // Replaces the pairs by `pairs`, which are in ascending order. Three functions decide what becomes of each:
  // - same(place) returns whether a pair that is in both lists is still of the same bodies. If so, its entry and its
  //   record stay; otherwise, it is a new pair.
  // - gone(known) is called for each busy pair that is not in `pairs`, or is not of the same bodies any more. In the
  //   first case, the pair is kept if it returns true.
  // - generations(pair) returns Known::generations of a new pair.
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
  std::vector<std::uint32_t> free_;                   // the indices of free records
  std::vector<Known> known_;
  std::vector<std::uint32_t> free_slots_;
  std::vector<BodyPair> pairs_, next_pairs_;
  static constexpr std::uint32_t kBusy = 0x80000000u, kSlot = kBusy - 1;
  std::vector<std::uint32_t> slots_, next_slots_;  // by place: an index into known_, plus kBusy if the pair is busy
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
