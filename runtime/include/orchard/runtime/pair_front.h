#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// Keeps where the last search through a pair of trees ended, so that the next one can start there.
namespace orchard::runtime {

namespace detail {

// Eight pairs of ball slabs, one slab of each of two trees. Each pair has a direction and a lower bound on the gap
// between the two slabs along it, or no known gap.
struct FrontBlock {
  using Lanes = std::array<float, kBlockWidth>;
  alignas(32) Lanes x, y, z, radius;  // The ball of the second slab, in the frame of its tree.
  alignas(32) Lanes ux, uy, uz;       // The direction, a unit vector from the first slab to the second.
  alignas(32) Lanes gap;              // The bound, in the units of the first tree; infinite in unused lanes.
  alignas(32) std::array<std::uint32_t, kBlockWidth> a, b;  // The slabs, as nodes of the first and of the second tree.
};

}  // namespace detail

// The front of a search through the trees of a pair: pairs of ball slabs that together contain all of both bodies. Each
// pair has a direction along which the two slabs are apart, and the gap along it. After a small motion most of them are
// still apart, which is tested eight at a time; the next search starts at the others instead of at the roots.
// TreePair::use() gives a front to a pair, for collide_coherently().
// A front is a plain value of fixed size. Keep one for each pair that stays close. It may be reused for another pair,
// for which it gives correct results, too.
class PairFront {
 public:
  // The maximum number of pairs of slabs. The pairs beyond it have one common bound on their distance.
  static constexpr std::uint32_t kRoom = 1024;
  void clear() noexcept {
    first_ = second_ = nullptr;
    crowded_ = false;
  }

 private:
  friend class FrontWalk;
  static constexpr std::uint32_t kBlocks = kRoom / kBlockWidth;

  const void *first_ = nullptr, *second_ = nullptr;  // The ball slabs of both trees.
  std::uint64_t fingerprints_[2] = {};
  Pose relative_;                            // The pose of the second tree in the first one's frame for these gaps.
  double rest_ = 0;                          // A lower bound on the distance of pairs that are in no block.
  std::uint32_t used_ = 0;                   // The number of lanes that have been filled so far.
  std::uint32_t free_count_ = 0;             // The number of these lanes that are free again.
  bool crowded_ = false;                     // Whether there were more pairs than kRoom.
  std::array<std::uint16_t, kRoom> free_{};  // The lanes that are free again.
  std::array<detail::FrontBlock, kBlocks> blocks_{};
};

}  // namespace orchard::runtime
