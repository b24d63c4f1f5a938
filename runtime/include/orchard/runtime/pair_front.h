#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime {

namespace detail {

// Eight pairs of ball slabs of two trees, each apart along a unit vector, or not known to be.
struct FrontBlock {
  using Lanes = std::array<float, kBlockWidth>;
  alignas(32) Lanes x, y, z, radius;  // the second one's ball, in its own frame
  alignas(32) Lanes ux, uy, uz;       // from the first one to the second one
  alignas(32) Lanes gap;              // along it, at least, in the first tree's units; infinite: unused
  alignas(32) std::array<std::uint32_t, kBlockWidth> a, b;  // nodes: ball slabs of the first and of the second tree
};

}  // namespace detail

// Where the last search through the trees of a pair ended: pairs of ball slabs that hold all of both bodies between
// them, each with a direction along which they are apart, and by how much. After a small motion most of them still are,
// which is seen eight at a time, and the next search begins at the others instead of the roots. Given to a pair by
// TreePair::use(), for collide_coherently(). A plain value of fixed size: keep as many as there are pairs that stay
// close, and hand them on to others. It says nothing wrong of whatever pair it is given to.
class PairFront {
 public:
  static constexpr std::uint32_t kRoom = 1024;  // pairs; what does not fit is kept as one bound
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
