#pragma once
#include "detector/pair_cache.h"
#include "detector/sample_states.h"
#include "detector/sphere_tree.h"

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
  // Appends the pairs of the step. `before`: those of the step before.
  void find(Step step, const PairCache& before, std::vector<BodyPair>& found);
  // Which bodies are searched by parts at the steps after this one. O(pairs), every 16 steps.
  void choose(Step step, const PairCache& pairs);
  void choose_none();
  void gone(const Body& body) noexcept;

  // What of the body the broad phase is to look at.
  static BodyFilter broad_filter(const Body& body) noexcept;
  std::size_t memory_bytes() const noexcept {
    return bytes_of(bodies_, touching_, static_pairs_, to_change_) + spheres_.memory_bytes() + 4 * bytes_of(lanes_[0]);
  }

 private:
  void search(BodyIndex body, bool wanted);
  void place_static();
  void append_touching(const BoundingSphere& sphere);

  World& world_;
  BroadPhase& broad_;
  StateSampler& sampler_;
  std::vector<BodyIndex> bodies_;             // in ascending order, are searched for by parts
  std::vector<BodyIndex> touching_;           // of static bodies
  SphereTree spheres_;                        // of all static bodies' parts, while there are such bodies,
  std::array<std::vector<double>, 4> lanes_;  // their x, y, z and radii, and some that are not numbers
  std::uint64_t static_changes_ = 0;          // as they were after so many changes
  Step choose_at_ = 0;
  std::vector<std::uint32_t> static_pairs_;  // by body, in choose()
  std::vector<BodyIndex> to_change_;
};

}  // namespace orchard::runtime::detail
