#pragma once
#include "detector/pair_cache.h"
#include "detector/sweep.h"

namespace orchard::runtime::detail {

// What a job needs while it answers pairs.
struct AnswerScratch {
  Workspace workspace{0};
  std::uint64_t work = 0;
};

// What is known of a pair before anything is asked: no parts of it are near. What two of its parts add to that. And
// where what happened between two steps is not known: "maybe", unless it touches at this one.
void forget_answer(CachedPair& record) noexcept;
void add(CachedPair& record, const Verdict& verdict, std::uint32_t part_a, std::uint32_t part_b) noexcept;
void leave_open(CachedPair& record) noexcept;

// Answers one pair of bodies from the poses of a step. Any number of threads may call it at once, each with its own
// scratch, for different pairs.
class PairAnswerer {
 public:
  explicit PairAnswerer(const ShapePlacements& places) noexcept : places_(&places) {}

  // Every pair of its parts to the end, and what happened between the step before and this one, if that can be swept.
  void answer(CachedPair& record, Step now, AnswerScratch& scratch) const noexcept;
  // What happened between the step before and this one, until scratch.work has reached `most`.
  void sweep(CachedPair& record, Step now, AnswerScratch& scratch, std::uint64_t most) const noexcept;

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
