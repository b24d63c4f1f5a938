#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>

#include "collision/kernels/farthest_first.h"
#include "collision/kernels/node_box.h"
#include "collision/kernels/triangle_block.h"
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

// The stack of a walk through two trees of triangles.
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
  std::span<const Entry> all() const noexcept { return {entries_.get(), size_}; }
  bool empty() const noexcept { return size_ == 0; }
  void clear() noexcept { size_ = 0; }
  void start(const Entry& roots) noexcept { entries_[0] = roots, size_ = 1; }
  Entry pop() noexcept { return entries_[--size_]; }
  void push(const Entry& entry) noexcept { entries_[size_++] = entry; }
  // Puts an entry for each of these lanes, as push_farthest_first() has it.
  template <typename EntryOf, typename KeyOf>
  ORCHARD_INLINE void push(std::uint32_t lanes, EntryOf&& entry_of, KeyOf&& key_of) noexcept {
    size_ = push_farthest_first(entries_.get(), size_, lanes, entry_of, key_of);
  }

 private:
  std::unique_ptr<Entry[]> entries_;
  std::size_t room_ = 0, size_ = 0;
};

// Which node of a pair is opened, and its children's block.
struct Opened {
  bool second;
  std::uint32_t block;

  NodePair pair(const NodePair& parents, std::uint32_t lane) const noexcept {
    const std::uint32_t node = block * kBlockWidth + lane;
    return second ? NodePair{parents.a, node} : NodePair{node, parents.b};
  }
};

inline float slab_radius(const TreeView& tree, std::uint32_t node) noexcept {
  return slab_block(tree, node).radius[node % kBlockWidth];
}

// Two trees of triangles, the second one placed in the first one's frame.
struct PlacedViews {
  const TreeView &first, &second;
  const Placement& placement;
  const Pose& relative;

  bool are_leaves(const NodePair& pair) const noexcept {
    return (slab_child(first, pair.a) & slab_child(second, pair.b) & kLeafBit) != 0;
  }
  // The triangles of two leaves.
  const TriangleBlock& lanes(const NodePair& leaves) const noexcept {
    return first.triangle_blocks[slab_child(first, leaves.a) & ~kLeafBit];
  }
  const TriangleBlock& rows(const NodePair& leaves) const noexcept {
    return second.triangle_blocks[slab_child(second, leaves.b) & ~kLeafBit];
  }
  // The boxes of two nodes, in the first tree's frame.
  NodeBox first_box(const NodePair& pair) const noexcept { return node_box_at(first, pair.a); }
  NodeBox second_box(const NodePair& pair) const noexcept { return moved(node_box_at(second, pair.b), placement); }
  float radii(const NodePair& pair) const noexcept {
    return slab_radius(first, pair.a) + slab_radius(second, pair.b) * placement.scale;
  }

  // Calls take(lane, row) for the triangles of two leaves that may share a point until it returns true, which is
  // returned then.
  template <typename Take>
  bool each_candidate(const NodePair& leaves, const Take& take) const noexcept {
    const NodeBox lane_box = first_box(leaves), row_box = second_box(leaves);
    return detail::each_candidate({lanes(leaves), rows(leaves), lane_box, row_box}, placement, take);
  }

  // The larger node. Precondition: not both are leaves.
  ORCHARD_INLINE Opened open(const NodePair& pair) const noexcept {
    const std::uint32_t a = slab_child(first, pair.a), b = slab_child(second, pair.b);
    const bool opens_second =
        (a & kLeafBit) != 0 ||
        ((b & kLeafBit) == 0 && slab_radius(first, pair.a) < slab_radius(second, pair.b) * placement.scale);
    return {opens_second, opens_second ? b : a};
  }
  // Calls test(single, lanes, scale) for the children and the other node, in the children's frame, as box_gaps() has
  // it.
  template <typename Test>
  ORCHARD_INLINE void with_children(const NodePair& pair, const Opened& opened, Test&& test) const noexcept {
    if (opened.second) {
      test(moved_back(first_box(pair), placement), second.obb_nodes[opened.block], placement.scale);
    } else {
      test(second_box(pair), first.obb_nodes[opened.block], 1.0f);
    }
  }
  ORCHARD_INLINE void compare_children(const NodePair& pair, const Opened& opened, BoxGaps& gaps) const noexcept {
    with_children(pair, opened,
                  [&](const NodeBox& single, const ObbNodeBlock& block, float scale)
                      ORCHARD_INLINE_LAMBDA { box_gaps(single, block, scale, placement.box_margin, gaps); });
  }
  // Those that may meet it: where floats are too coarse, boxes that they do not separate are tested in double.
  ORCHARD_INLINE void meeting_children(const NodePair& pair, const Opened& opened, BoxGaps& gaps) const noexcept {
    compare_children(pair, opened, gaps);
    if (!placement.coarse) return;
    for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      const NodePair child = opened.pair(pair, lane);
      if (boxes_are_apart(node_box_at(first, child.a), node_box_at(second, child.b), relative)) {
        gaps.meeting &= ~(1u << lane);
      }
    }
  }
};

}  // namespace detail
}  // namespace orchard::runtime
