#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

#include "collision/kernels/node_box.h"
#include "collision/kernels/obb_node_block.h"
#include "orchard/runtime/packed_tree.h"
#include "simd/vector_support.h"
#include "tree/tree_nodes.h"

// What the walks through the two trees of a pair share. They go depth first: a pair of nodes gives way to the pairs of
// the larger node's children with the other node.
namespace orchard::runtime {

struct NodePair {  // of the two trees of spheres, or of triangles
  std::uint32_t a, b;
};

namespace detail {

// The stack of a walk through two trees of triangles; its user counts what is on it.
template <typename Entry>
class TreeStack {
 public:
  // Room for two trees, where each step puts at most so many entries in the place of one, one level deeper in one of
  // the trees. False if there is no memory.
  bool reserve(const TreeView& a, const TreeView& b, std::size_t most = kBlockWidth) noexcept {
    const std::size_t deepest = most * (a.triangle_tree_depth + b.triangle_tree_depth + 1) + 1;
    if (deepest <= room_) return true;
    entries_.reset(new (std::nothrow) Entry[deepest]);
    room_ = entries_ ? deepest : 0;
    return entries_ != nullptr;
  }
  bool has_room() const noexcept { return entries_ != nullptr; }
  Entry* data() const noexcept { return entries_.get(); }
  Entry& operator[](std::size_t i) const noexcept { return entries_[i]; }

 private:
  std::unique_ptr<Entry[]> entries_;
  std::size_t room_ = 0;
};

inline float slab_radius(const TreeView& tree, std::uint32_t node) noexcept {
  return slab_block(tree, node).radius[node % kBlockWidth];
}

// Which node of a pair is opened, and its children's block. Precondition: not both are leaves.
struct Opened {
  bool second;
  std::uint32_t block;

  NodePair pair(const NodePair& parents, std::uint32_t lane) const noexcept {
    const std::uint32_t node = block * kBlockWidth + lane;
    return second ? NodePair{parents.a, node} : NodePair{node, parents.b};
  }
};

// `a`, `b`: slab_child() of both.
ORCHARD_INLINE Opened larger_node(const TreeView& first, const TreeView& second, const NodePair& pair, std::uint32_t a,
                                  std::uint32_t b, float scale) noexcept {
  const bool opens_second =
      (a & kLeafBit) != 0 || ((b & kLeafBit) == 0 && slab_radius(first, pair.a) < slab_radius(second, pair.b) * scale);
  return {opens_second, opens_second ? b : a};
}
ORCHARD_INLINE Opened larger_node(const TreeView& first, const TreeView& second, const NodePair& pair,
                                  float scale) noexcept {
  return larger_node(first, second, pair, slab_child(first, pair.a), slab_child(second, pair.b), scale);
}

// Calls test(single, lanes, scale) for the children against the other node of the pair, in the children's frame, as
// box_gaps() has it.
template <typename Test>
ORCHARD_INLINE void with_children(const TreeView& first, const TreeView& second, const Placement& placement,
                                  const NodePair& pair, const Opened& opened, Test&& test) noexcept {
  if (opened.second) {
    test(moved_back(node_box_at(first, pair.a), placement), second.obb_nodes[opened.block], placement.scale);
  } else {
    test(moved(node_box_at(second, pair.b), placement), first.obb_nodes[opened.block], 1.0f);
  }
}
ORCHARD_INLINE void compare_children(const TreeView& first, const TreeView& second, const Placement& placement,
                                     const NodePair& pair, const Opened& opened, float margin, BoxGaps& gaps) noexcept {
  with_children(first, second, placement, pair, opened,
                [&](const NodeBox& single, const ObbNodeBlock& lanes, float scale)
                    ORCHARD_INLINE_LAMBDA { box_gaps(single, lanes, scale, margin, gaps); });
}

// Those that may meet it: where floats are too coarse, boxes that they do not separate are tested in double.
ORCHARD_INLINE void meeting_children(const TreeView& first, const TreeView& second, const Placement& placement,
                                     const Pose& relative, const NodePair& pair, const Opened& opened,
                                     BoxGaps& gaps) noexcept {
  compare_children(first, second, placement, pair, opened, placement.box_margin, gaps);
  if (!placement.coarse) return;
  for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
    const NodePair child = opened.pair(pair, lane);
    if (boxes_are_apart(node_box_at(first, child.a), node_box_at(second, child.b), relative)) {
      gaps.meeting &= ~(1u << lane);
    }
  }
}

}  // namespace detail
}  // namespace orchard::runtime
