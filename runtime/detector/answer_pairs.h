#pragma once
#include "detector/pair_cache.h"
#include "detector/sweep.h"

namespace orchard::runtime::detail {

// The workspace of one job that answers pairs, and the work that it has done, in units of Budget::work.
struct AnswerScratch {
  Workspace workspace{0};
  std::uint64_t work = 0;
};

// Resets the answer of a pair to what holds before any of its parts are compared: "no", with infinite bounds.
void forget_answer(CachedPair& record) noexcept;
// Adds the verdict of two parts to the answer of their bodies. The verdict that decides() prefers is kept, with the
// smaller of both bounds.
void add(CachedPair& record, const Verdict& verdict, std::uint32_t part_a, std::uint32_t part_b) noexcept;
// Changes the answer of a pair to an uncertain "maybe", unless the bodies touch at this step. It is for pairs of which
// it is not known what happened between two steps.
void leave_open(CachedPair& record) noexcept;

// Answers one pair of bodies from the poses of a step. Any number of threads may call it at once, each with its own
// scratch, for different pairs.
class PairAnswerer {
 public:
  explicit PairAnswerer(const ShapePlacements& places) noexcept : places_(&places) {}

  // Answers the pair without a limit of work: compares parts until two of them touch or none is left. If
  // record.sweep.possible is set, it then sweeps.
  void answer(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept;
  // Searches for an impact between the step before and this one. It stops once scratch.work has reached `most`, and the
  // parts that it has not searched to the end count as "maybe".
  void sweep(CachedPair& record, Step now, AnswerScratch& scratch, std::uint64_t most) const noexcept;

  // Sets `pair` to two parts of the bodies, at the poses of the step under way.
  void place(const CachedPair& record, std::uint32_t part_a, std::uint32_t part_b, PartPair& pair) const noexcept;

 private:
  static Verdict answer_again(CachedPair& record, std::uint32_t guess, const PartPair& pair,
                              AnswerScratch& scratch) noexcept;
  static Verdict answer_new(CachedPair& record, const PartPair& pair, AnswerScratch& scratch) noexcept;
  void answer_coherently(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept;
  using Parts = std::array<std::uint32_t, 2>;
  bool answer_others(CachedPair& record, const std::optional<Parts>& but, PartPair& pair,
                     AnswerScratch& scratch) const noexcept;
  void answer_parts(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept;

  const ShapePlacements* places_;
};

}  // namespace orchard::runtime::detail
