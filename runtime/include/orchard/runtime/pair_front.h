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

// Eight pairs of ball slabs of two trees. Each pair is apart along a unit vector, or not known to be.
struct FrontBlock {
  using Lanes = std::array<float, kBlockWidth>;
  alignas(32) Lanes x, y, z, radius;  // the second one's ball, in its own frame
  alignas(32) Lanes ux, uy, uz;       // from the first one to the second one
  alignas(32) Lanes gap;              // along it, at least, in the first tree's units; infinite: unused
  alignas(32) std::array<std::uint32_t, kBlockWidth> a, b;  // nodes: ball slabs of the first and of the second tree
};

}  // namespace detail

// The front of a search through the trees of a pair: pairs of ball slabs that together contain all of both bodies, each
// with a direction along which they are apart, and by how much. After a small motion most of them are still apart,
// which is tested eight at a time, and the next search starts at the others instead of the roots. TreePair::use() gives
// a front to a pair, for collide_coherently().
// A front is a plain value of fixed size. Keep one for each pair that stays close, and reuse it for other pairs: it
// gives no wrong results for any pair.
class PairFront {
 public:
  // The number of pairs; what does not fit is kept as one bound.
  static constexpr std::uint32_t kRoom = 1024;
  void clear() noexcept {
    first_ = second_ = nullptr;
    crowded_ = false;
  }

 private:
  friend class FrontWalk;
  static constexpr std::uint32_t kBlocks = kRoom / kBlockWidth;

  const void *first_ = nullptr, *second_ = nullptr;  // the trees' ball slabs
  std::uint64_t fingerprints_[2] = {};
  Pose relative_;           // of the second tree in the first one's frame, when the gaps held
  double rest_ = 0;         // lower bound on the distance of what is in no block, likewise
  std::uint32_t used_ = 0;  // lanes that have ever been filled
  std::uint32_t free_count_ = 0;
  bool crowded_ = false;                     // there has been no room for some
  std::array<std::uint16_t, kRoom> free_{};  // lanes among them that are free again
  std::array<detail::FrontBlock, kBlocks> blocks_{};
};

}  // namespace orchard::runtime
