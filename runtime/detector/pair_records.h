#pragma once
#include "orchard/runtime/body_pair.h"
#include "pair_tests.h"

namespace orchard::runtime::detail {

inline constexpr std::uint32_t kNoFront = 0xffffffffu;

// What is remembered of a pair while its spheres overlap, or until its touch has ended.
struct Record {
  BodyPair pair{};
  BodyId a, b;
  std::uint32_t filters_a = 0, filters_b = 0, filter_version = 0;  // of when it was allowed, or not
  std::uint32_t jumps = 0;                                         // teleports of both, so far
  std::uint32_t deformed = 0;                                      // and changes of their shapes
  bool coherent = false;  // one tree each: `trees` knows what the last answer was
  TreePair trees;
  std::uint32_t front = kNoFront;  // that `trees` has of the FrontPool
  bool large = false;              // trees, so that a front may be of use
  std::uint8_t costly = 0;         // searches of late, see there
  std::uint8_t roots_wait = 0;     // steps within a budget for which the roots are not asked by themselves
  Vec3 apart_by{};                 // from centre to centre,
  Step apart_at = -1;              // at that step
  bool allowed = false;
  bool touching = false;
  bool swept = false;   // at the step before both poses were known: a sweep may start there
  bool unseen = false;  // they were not, and should have been: nobody knows what was in between
  std::uint8_t importance = 0;
  std::uint32_t nos = 0;     // certain ones in a row, while touching
  std::uint32_t waited = 0;  // steps without a certain answer
  Step answered = -1;        // the step of `verdict`, if that is certain
  std::uint32_t part_a = 0, part_b = 0;
  Verdict verdict;
  double impact_from = 0, impact_to = 0;
  bool impact = false;
};

// A certain "no" that lasts: the two are `distance` apart, at least, as long as their middles are this way from each
// other and they have turned so far; see Whereabouts.
struct Clearance {
  double distance = 0;  // 0: none
  Vec3 way{};
  double turned = 0;
  std::uint32_t changes = 0;
};

// The pairs of the step before and their records, in ascending order of pairs.
class RecordTable {
 public:
  struct Known {  // no larger than a line of memory: most pairs of a step are asked no more than this
    BodyPair pair;
    std::uint32_t record;
    std::uint32_t generations;  // of both bodies: others have others
    Clearance clearance;
  };

  std::span<const Known> known() const noexcept { return known_; }
  // Those of them that match() has not found to be clear.
  std::span<const std::uint32_t> active() const noexcept { return active_; }
  Known& operator()(std::uint32_t active) noexcept { return known_[active]; }
  Record& operator[](std::uint32_t record) noexcept { return records_[record]; }
  const Record& operator[](std::uint32_t record) const noexcept { return records_[record]; }

  // Those of `pairs`, which ascend, become the known ones; asks clear(known) of each that has been one; calls
  // gone(record) for each that is not among them, or whose bodies are others by now, as the sum of their generations
  // tells, and keeps it if that says true; fresh(record) for each new one.
  template <typename IdOf, typename Generations, typename Clear, typename Gone, typename Fresh>
  void match(std::span<const BodyPair> pairs, IdOf&& id_of, Generations&& generations, Clear&& clear, Gone&& gone,
             Fresh&& fresh);
  std::size_t memory_bytes() const noexcept {
    return bytes_of(records_) + bytes_of(free_) + bytes_of(known_) + bytes_of(next_) + bytes_of(active_);
  }

 private:
  std::uint32_t take() {
    if (free_.empty()) {
      records_.emplace_back();
      free_.reserve(records_.capacity());
      return static_cast<std::uint32_t>(records_.size() - 1);
    }
    const std::uint32_t record = free_.back();
    free_.pop_back();
    records_[record] = Record{};
    return record;
  }
  std::vector<Record> records_;
  std::vector<std::uint32_t> free_;
  std::vector<Known> known_, next_;
  std::vector<std::uint32_t> active_;  // of known_
};

template <typename IdOf, typename Generations, typename Clear, typename Gone, typename Fresh>
void RecordTable::match(std::span<const BodyPair> pairs, IdOf&& id_of, Generations&& generations, Clear&& clear,
                        Gone&& gone, Fresh&& fresh) {
  next_.clear();
  active_.clear();
  const auto keep_active = [this](const Known& known) {
    active_.push_back(static_cast<std::uint32_t>(next_.size()));
    next_.push_back(known);
    next_.back().clearance.distance = 0;
  };
  std::size_t old = 0;
  const auto leave = [&] {
    const Known known = known_[old++];
    if (gone(records_[known.record])) {
      next_.push_back(known);
      next_.back().clearance.distance = 0;
    } else {
      free_.push_back(known.record);
    }
  };
  for (const BodyPair& pair : pairs) {
    while (old < known_.size() && known_[old].pair < pair) leave();
    if (old < known_.size() && known_[old].pair == pair) {
      if (clear(known_[old])) {
        next_.push_back(known_[old++]);
        continue;
      }
      if (known_[old].generations == generations(pair)) {
        keep_active(known_[old++]);
        continue;
      }
      gone(records_[known_[old].record]);  // of a body that is no more: it cannot stay
      free_.push_back(known_[old++].record);
    }
    const std::uint32_t index = take();
    Record& record = records_[index];
    record.pair = pair;
    record.a = id_of(pair.a), record.b = id_of(pair.b);
    fresh(record);
    keep_active({pair, index, generations(pair), {}});
  }
  while (old < known_.size()) leave();
  std::swap(known_, next_);
}

}  // namespace orchard::runtime::detail
