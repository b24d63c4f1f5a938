#pragma once
#include "detector/pair_cache.h"
#include "detector/world.h"

namespace orchard::runtime::detail {

// The active pairs of a step: those that may not be skipped.
class ActivePairs {
 public:
  ActivePairs(PairCache& cache, const ShapePlacements& places, std::span<const std::uint32_t> active) noexcept
      : cache_(&cache), places_(&places), active_(active) {}
  std::size_t size() const noexcept { return active_.size(); }
  const BodyPair& pair(std::size_t i) const noexcept { return cache_->pair(active_[i]); }
  PairCache::Known& known(std::size_t i) const noexcept { return cache_->known(active_[i]); }
  CachedPair& cached(std::size_t i) const noexcept { return (*cache_)[known(i).record]; }
  // Sets what PairCache::busy() returns for the pair at the next step.
  void tell(std::size_t i, bool busy) const noexcept { cache_->tell(active_[i], busy); }
  // Prefetches what the next passes of a loop over the pairs need.
  ORCHARD_INLINE void prefetch(std::size_t i) const noexcept {
    constexpr std::size_t kKnown = 12, kCached = 8, kBodies = 6;  // places ahead
    if (i + kKnown < size()) cache_->prefetch_known(active_[i + kKnown]);
    if (i + kCached < size()) prefetch_all(cached(i + kCached));
    if (i + kBodies < size()) places_->prefetch_bodies(pair(i + kBodies));
  }

 private:
  PairCache* cache_;
  const ShapePlacements* places_;
  std::span<const std::uint32_t> active_;  // places in the cache
};

// Decides which pairs may be skipped at a step:
//   1. pairs whose spheres are apart;
//   2. pairs that have moved less since a certain "no" than they were apart then;
//   3. pairs that have not moved at all since a certain answer.
class PairSkipper {
 public:
  explicit PairSkipper(const World& world) noexcept : world_(world) {}

  // Returns all pairs except those of kinds 1 and 2, and gives each of them a record. The result is valid until the
  // next call.
  ActivePairs find_active(PairCache& cache);
  // Returns whether an active pair has to be answered, because it is not of kind 3 either. Also decides whether it has
  // to be swept. `interrupted`: the broad phase was interrupted at the step before.
  bool needs_answer(CachedPair& pair, Step step, bool interrupted) const noexcept;
  // Call it after each answer. If that is a certain "no", it stores how far the bodies may move before the pair has to
  // be answered again.
  void keep_clearance(PairCache::Known& known, const CachedPair& pair) const noexcept;
  std::size_t memory_bytes() const noexcept { return bytes_of(active_, active_of_job_); }

 private:
  RelativePlacement relative_placement(const BodyPair& pair) const noexcept;
  bool moved_less_than_gap(const PairCache::Known& known) const noexcept;
  bool parts_apart(const BodyPair& pair) const noexcept;
  std::size_t find_near(PairCache& cache, std::size_t begin, std::size_t end, std::uint32_t* near) const noexcept;

  const World& world_;
  std::vector<std::uint32_t> active_;       // places in the cache
  std::vector<std::size_t> active_of_job_;  // the number of active pairs that each job has found
};

}  // namespace orchard::runtime::detail
