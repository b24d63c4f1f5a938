#pragma once
#include "detector/pair_cache.h"
#include "detector/world.h"

namespace orchard::runtime::detail {

// The pairs of a step that may not be skipped.
class ActivePairs {
 public:
  ActivePairs(PairCache& cache, const ShapePlacements& places, std::span<const std::uint32_t> active) noexcept
      : cache_(&cache), places_(&places), active_(active) {}
  std::size_t size() const noexcept { return active_.size(); }
  const BodyPair& pair(std::size_t i) const noexcept { return cache_->pair(active_[i]); }
  PairCache::Known& known(std::size_t i) const noexcept { return cache_->known(active_[i]); }
  CachedPair& cached(std::size_t i) const noexcept { return (*cache_)[known(i).record]; }
  // Whether a certain "no" at the next step would change what is remembered, or the pair's end would be noticed.
  void tell(std::size_t i, bool busy) const noexcept { cache_->tell(active_[i], busy); }
  // For loops: what the next ones need is on its way from memory.
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

// Decides which pairs may be skipped at a step: those whose spheres are apart, those that have moved less since a
// certain "no" than they were apart then, and those that have not moved at all since a certain answer.
class PairSkipper {
 public:
  explicit PairSkipper(const World& world) noexcept : world_(world) {}

  // All pairs but those of the first two kinds. Valid until the next call.
  ActivePairs find_active(PairCache& cache);
  // Of an active pair, whether it is of no third kind either. `interrupted`: the broad phase was at the step before.
  bool needs_answer(CachedPair& pair, Step step, bool interrupted) const noexcept;
  // After an answer: how far the two may move before they have to be asked about again.
  void keep_clearance(PairCache::Known& known, const CachedPair& pair) const noexcept;
  std::size_t memory_bytes() const noexcept { return bytes_of(active_, active_of_job_); }

 private:
  RelativePlacement relative_placement(const BodyPair& pair) const noexcept;
  bool moved_less_than_gap(const PairCache::Known& known) const noexcept;
  bool parts_apart(const BodyPair& pair) const noexcept;
  std::size_t find_near(PairCache& cache, std::size_t begin, std::size_t end, std::uint32_t* near) const noexcept;

  const World& world_;
  std::vector<std::uint32_t> active_;       // places in the cache
  std::vector<std::size_t> active_of_job_;  // how many
};

}  // namespace orchard::runtime::detail
