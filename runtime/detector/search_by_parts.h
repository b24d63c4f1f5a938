#pragma once
#include "detector/pair_cache.h"
#include "detector/part_search.h"
#include "detector/sample_states.h"

namespace orchard::runtime::detail {

// Pairs of bodies of several parts with static bodies, where there are many of these: the broad phase is spared them,
// and PartSearch finds them. Chooses for which bodies that pays.
class PartPairs {
 public:
  PartPairs(World& world, BroadPhase& broad, StateSampler& sampler) noexcept
      : world_(world), broad_(broad), sampler_(sampler) {}

  bool any() const noexcept { return search_.any(); }
  // Whether the pair is found here and by no other part of the detector.
  bool finds(const BodyPair& pair) const noexcept;
  // The pairs of the step, in ascending order. `before`: those of the step before.
  void find(Step step, const PairCache& before, std::vector<BodyPair>& found);
  // Which bodies are searched by parts at the steps after this one. O(pairs), every 16 steps.
  void choose(Step step, const PairCache& pairs);
  void choose_none();

  // What of the body the broad phase is to look at.
  static BodyFilter broad_filter(const Body& body) noexcept;
  void static_changed(BodyIndex body) { search_.static_changed(body, world_.bodies); }
  void gone(const Body& body) noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  void keep_pairs_of(BodyIndex body, const PairCache& before, std::vector<BodyPair>& found) const;
  void search(BodyIndex body, bool wanted);

  World& world_;
  BroadPhase& broad_;
  StateSampler& sampler_;
  PartSearch search_;
  Step choose_at_ = 0;
  std::vector<std::uint32_t> static_pairs_;  // by body, in choose()
  std::vector<BodyIndex> to_change_;
};

}  // namespace orchard::runtime::detail
