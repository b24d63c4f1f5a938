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

// What the walks through the two trees of a pair share. They are depth first: a pair of nodes is replaced by the pairs
// of the larger node's children with the other node.
namespace orchard::runtime {

struct NodePair {  // a node of each tree, of spheres or of triangles
  std::uint32_t a, b;
};

namespace detail {

// The stack of a walk through two trees of triangles.
template <typename Entry>
class TreeStack {
 public:
  // Makes room for a walk through two trees in which each step replaces an entry by at most `most` entries, one level
  // deeper in one of the trees. Returns false if there is no memory.
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
  // Pushes an entry for each lane of a bit mask, in the order of push_farthest_first().
  template <typename EntryOf, typename KeyOf>
  ORCHARD_INLINE void push(std::uint32_t lanes, EntryOf&& entry_of, KeyOf&& key_of) noexcept {
    size_ = push_farthest_first(entries_.get(), size_, lanes, entry_of, key_of);
  }

 private:
  std::unique_ptr<Entry[]> entries_;
  std::size_t room_ = 0, size_ = 0;
};

// The node of a pair that is opened: whether it is the second one, and the block of its children.
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

  // Calls take(lane, row) for the triangles of two leaves that may share a point, until it returns true. Returns
  // whether it did.
  template <typename Take>
  bool each_candidate(const NodePair& leaves, const Take& take) const noexcept {
    const NodeBox lane_box = first_box(leaves), row_box = second_box(leaves);
    return detail::each_candidate({lanes(leaves), rows(leaves), lane_box, row_box}, placement, take);
  }

  // Opens the larger node, or the one that is no leaf. Precondition: not both are leaves.
  ORCHARD_INLINE Opened open(const NodePair& pair) const noexcept {
    const std::uint32_t a = slab_child(first, pair.a), b = slab_child(second, pair.b);
    const bool opens_second =
        (a & kLeafBit) != 0 ||
        ((b & kLeafBit) == 0 && slab_radius(first, pair.a) < slab_radius(second, pair.b) * placement.scale);
    return {opens_second, opens_second ? b : a};
  }
  // Calls test(single, lanes, scale) with the other node, moved to the frame of the children, and with the children.
  // These are the parameters of box_gaps().
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
  // Sets gaps.meeting to the children that may meet the other node. If floats are too coarse for the pair, boxes that
  // they do not separate are tested in double.
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
