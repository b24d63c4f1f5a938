#pragma once
#include "detector/pair_cache.h"
#include "detector/sample_states.h"
#include "detector/sphere_tree.h"

namespace orchard::runtime::detail {

// Finds the pairs of bodies of several parts with static bodies, where there are many of these. The sphere around all
// parts of a robot arm is mostly empty and may contain all static bodies of a factory cell. So the broad phase does not
// look for these pairs; they are found at each step by the spheres of the parts. (This is like the several horns for
// one body in section 4.1.2 of the dissertation, but for one step only, because there are no bounds on the motion of
// joints.) choose() decides for which bodies that pays.
class PartPairs {
 public:
  PartPairs(World& world, BroadPhase& broad, StateSampler& sampler) noexcept
      : world_(world), broad_(broad), sampler_(sampler) {}

  bool any() const noexcept { return !bodies_.empty(); }
  // Returns whether the pair is found here and not by the broad phase.
  bool finds(const BodyPair& pair) const noexcept;
  // Appends the pairs of the step. A body without a valid state keeps its pairs of the step before, which `before` has.
  void find(Step step, const PairCache& before, std::vector<BodyPair>& found);
  // Chooses every 16 steps which bodies are searched by parts at the steps after this one. O(pairs).
  void choose(Step step, const PairCache& pairs);
  void choose_none();                    // gives all bodies back to the broad phase
  void gone(const Body& body) noexcept;  // the body is removed, or given back to the broad phase

  // Returns the filter of the body for the broad phase, which excludes static bodies if their pairs are found here.
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
  std::vector<BodyIndex> bodies_;             // the bodies that are searched by parts, in ascending order
  std::vector<BodyIndex> touching_;           // scratch: static bodies that touch a sphere
  SphereTree spheres_;                        // the parts of all static bodies, while bodies_ is not empty
  std::array<std::vector<double>, 4> lanes_;  // the x, y, z and radii of these, then NaN for the lanes beyond
  std::uint64_t static_changes_ = 0;          // World::static_changes when spheres_ was built
  Step choose_at_ = 0;
  std::vector<std::uint32_t> static_pairs_;  // by body, in choose(): the number of its pairs with static bodies
  std::vector<BodyIndex> to_change_;
};

}  // namespace orchard::runtime::detail
