#pragma once
#include "detector/load_model.h"
#include "detector/search_by_parts.h"

namespace orchard::runtime::detail {

// Match: which pairs of bodies a step asks about, and what is remembered of each from the step before.
class PairMatcher {
 public:
  PairMatcher(World& world, StateSampler& sampler, PartPairs& part_pairs) noexcept
      : world_(world), sampler_(sampler), part_pairs_(part_pairs) {}

  // Whether no step has pairs before the broad phase, or a half-space, finds some.
  bool idle() const noexcept { return cache_.empty() && !part_pairs_.any(); }
  void expect(double meetings) noexcept { seen_.meetings = meetings; }  // as the timing wheel has announced them
  // The pairs of the step, in ascending order: the broad phase's, those with half-spaces, those found by parts, and
  // those of the step before that an interrupted broad phase may have left out. Samples the states of their bodies.
  void gather(Step step, const Advance& now);
  // Matches them with those of the step before. Calls goes_on(pair) for each held pair that is none any more; true
  // keeps it.
  template <typename GoesOn>
  void match(GoesOn&& goes_on);
  std::size_t pair_count() const noexcept { return pairs_.size(); }
  const LoadModel::Pairs& seen() const noexcept { return seen_; }

  PairCache& cache() noexcept { return cache_; }
  const PairCache& cache() const noexcept { return cache_; }
  // What is remembered of a pair that has to be asked about, from the first time on.
  CachedPair& cached(PairCache::Known& known);
  // By the filters of both bodies and of the application, which is asked again only after something has changed.
  bool allowed(CachedPair& pair) const;
  bool is_there(const CachedPair& pair) const noexcept { return world_.contains(pair.a) && world_.contains(pair.b); }
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
  std::uint32_t generations(const BodyPair& pair) const noexcept {
    const std::uint32_t first = world_.bodies.sphere_cache(pair.a).generation;
    return is_half_space(pair.b) ? first : first + world_.bodies.sphere_cache(pair.b).generation;
  }

  World& world_;
  StateSampler& sampler_;
  PartPairs& part_pairs_;
  PairCache cache_;
  std::span<const BodyPair> pairs_;  // of the step: those of the broad phase and
  std::vector<BodyPair> others_;     // those that it does not know of,
  std::vector<BodyPair> merged_;     // together, if there are any
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
