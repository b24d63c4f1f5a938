#pragma once
#include "detector/pair_cache.h"
#include "detector/sample_states.h"
#include "detector/static_spheres.h"

namespace orchard::runtime::detail {

// Pairs of bodies of several parts with static bodies, where there are many of these. The sphere around all parts of a
// robot arm is mostly empty and may contain all static bodies of a factory cell. So the broad phase does not look for
// these pairs; they are found at each step by the spheres of the parts. (This is like the several horns for one body of
// 4.1.2, but for one step only, because there are no bounds on the motion of joints.) Chooses for which bodies that
// pays.
class PartPairs {
 public:
  PartPairs(World& world, BroadPhase& broad, StateSampler& sampler) noexcept
      : world_(world), broad_(broad), sampler_(sampler) {}

  bool any() const noexcept { return !bodies_.empty(); }
  // Whether the pair is found here and by no other part of the detector.
  bool finds(const BodyPair& pair) const noexcept;
  // The pairs of the step, in ascending order. `before`: those of the step before.
  void find(Step step, const PairCache& before, std::vector<BodyPair>& found);
  // Which bodies are searched by parts at the steps after this one. O(pairs), every 16 steps.
  void choose(Step step, const PairCache& pairs);
  void choose_none();

  // What of the body the broad phase is to look at.
  static BodyFilter broad_filter(const Body& body) noexcept;
  void static_changed(BodyIndex body);  // it was added or moved
  void gone(const Body& body) noexcept;
  std::size_t memory_bytes() const noexcept;

 private:
  void keep_pairs_of(BodyIndex body, const PairCache& before, std::vector<BodyPair>& found) const;
  void search(BodyIndex body, bool wanted);
  void end(BodyIndex body) noexcept;
  std::span<const BodyIndex> touching(std::span<const FloatSphere> spheres);

  World& world_;
  BroadPhase& broad_;
  StateSampler& sampler_;
  std::vector<BodyIndex> bodies_, touching_;  // the former, in ascending order, are searched for by parts
  StaticSpheres spheres_;                     // of all static bodies while there are such bodies
  Step choose_at_ = 0;
  std::vector<std::uint32_t> static_pairs_;  // by body, in choose()
  std::vector<BodyIndex> to_change_;
};

}  // namespace orchard::runtime::detail
