#pragma once
#include "detector/load_model.h"
#include "detector/search_by_parts.h"

namespace orchard::runtime::detail {

// The stage "match" of a step: collects the pairs of bodies that the step has to answer, and finds what is remembered
// of each from the step before.
class PairMatcher {
 public:
  PairMatcher(World& world, StateSampler& sampler, PartPairs& part_pairs) noexcept
      : world_(world), sampler_(sampler), part_pairs_(part_pairs) {}

  // Returns whether steps have no pairs until the broad phase or a half-space finds some.
  bool idle() const noexcept { return cache_.empty() && !part_pairs_.any(); }
  // Notes how many meetings the broad phase predicts for the next step.
  void expect(double meetings) noexcept { seen_.meetings = meetings; }
  // Collects the pairs of the step, in ascending order: those of the broad phase, those with half-spaces, those found
  // by parts, and those of the step before that an interrupted broad phase may have left out. Samples the states of
  // their bodies.
  void gather(Step step, const Advance& now);
  // Matches the collected pairs with those of the step before. Calls goes_on(pair) for each pair of the step before
  // that is none any more and that is PairCache::busy(). The pair is kept if that returns true.
  template <typename GoesOn>
  void match(GoesOn&& goes_on);
  std::size_t pair_count() const noexcept { return pairs_.size(); }
  const LoadModel::Pairs& seen() const noexcept { return seen_; }

  PairCache& cache() noexcept { return cache_; }
  const PairCache& cache() const noexcept { return cache_; }
  // Returns the record of an active pair, and fills it in the first time.
  CachedPair& cached(PairCache::Known& known);
  // Returns whether the filters of both bodies and of the application allow the pair. The filters are asked again only
  // after one of them has changed.
  bool allowed(CachedPair& pair) const;
  // Returns whether both bodies still exist.
  bool is_there(const CachedPair& pair) const noexcept { return world_.contains(pair.a) && world_.contains(pair.b); }
  // Returns whether a body was teleported since the pair was last looked at.
  bool has_jumped(const CachedPair& pair) const noexcept {
    return pair.versions.jumps !=
           world_.places.body(pair.bodies.a).changes.jumps + world_.places.body(pair.bodies.b).changes.jumps;
  }
  std::size_t memory_bytes() const noexcept {
    return cache_.memory_bytes() + bytes_of(others_, merged_, due_, left_out_);
  }

 private:
  std::uint32_t filter_changes(const Body& a, const Body& b) const noexcept {
    return world_.filter_version + a.changes.filters + b.changes.filters;
  }
  void gather_half_spaces(Step step);
  void gather_left_out(Step step, const Advance& now);
  // Returns the sum of the generations of both bodies.
  std::uint32_t generations(const BodyPair& pair) const noexcept {
    const std::uint32_t first = world_.bodies.sphere_cache(pair.a).generation;
    return is_half_space(pair.b) ? first : first + world_.bodies.sphere_cache(pair.b).generation;
  }

  World& world_;
  StateSampler& sampler_;
  PartPairs& part_pairs_;
  PairCache cache_;
  std::span<const BodyPair> pairs_;  // all pairs of the step: the list of the broad phase, others_ or merged_
  std::vector<BodyPair> others_;     // the pairs that the broad phase does not report
  std::vector<BodyPair> merged_;     // the pairs of both lists, if neither is empty
  LoadModel::Pairs seen_;
  std::vector<BodyIndex> due_, left_out_;
};

template <typename GoesOn>
void PairMatcher::match(GoesOn&& goes_on) {
  seen_.known = cache_.size(), seen_.fresh = 0;
  BodyTable& bodies = world_.bodies;
  const auto same = [&](std::size_t place) {
    const BodyPair& pair = cache_.pair(place);
    return !bodies.invalidated(pair) || cache_.known(place).generations == generations(pair);
  };
  const auto gone = [&](const PairCache::Known& known) { return goes_on(cache_[known.record]); };
  const auto fresh = [&](const BodyPair& pair) {
    ++seen_.fresh;
    return generations(pair);
  };
  cache_.match(pairs_, same, gone, fresh);
  seen_.parted = seen_.known + seen_.fresh + cache_.kept().size() - cache_.size();
  bodies.forget_invalidated();
}

}  // namespace orchard::runtime::detail
