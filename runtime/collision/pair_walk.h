#pragma once
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>

#include "collision/kernels/node_box.h"
#include "collision/kernels/obb_node_block.h"
#include "orchard/runtime/packed_tree.h"

// Depth first through the two trees of triangles of a pair, to every pair of triangles that meet.
namespace orchard::runtime::detail {

// Two trees, the second one placed in the first one's frame, both relative to their origins.
struct PlacedPair {
  const PreparedTree &first, &second;
  Pose relative;
  Placement placement;

  // The second one moved by `by`, in the first one's units.
  PlacedPair moved(const Vec3& by) const noexcept {
    PlacedPair result = *this;
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      result.relative.translation[i] += by[i];
      result.placement.translation[i] = static_cast<float>(result.relative.translation[i]);
      size += std::fabs(by[i]);
    }
    // A margin has at most 108 u for each unit of the translation's length, or 204 u (narrow_phase.cpp).
    result.placement.margin += static_cast<float>(size * 0x1p-17);
    result.placement.box_margin += static_cast<float>(size * 0x1p-16);
    return result;
  }
};

struct WalkPair {  // nodes that may meet
  std::uint32_t a, b;
};

class WalkStack {
 public:
  // Room for two trees. False if there is no memory.
  bool reserve(const TreeView& a, const TreeView& b) noexcept {
    const std::size_t deepest = std::size_t{kBlockWidth} * (a.triangle_tree_depth + b.triangle_tree_depth + 1) + 1;
    if (deepest <= room_) return true;
    pairs_.reset(new (std::nothrow) WalkPair[deepest]);
    room_ = pairs_ ? deepest : 0;
    return pairs_ != nullptr;
  }
  WalkPair* data() const noexcept { return pairs_.get(); }
  // The tests of eight against one, of leaves, and visits to triangles so far.
  std::uint64_t work() const noexcept { return work_; }
  void spend(std::uint64_t tests) noexcept { work_ += tests; }

 private:
  std::unique_ptr<WalkPair[]> pairs_;
  std::size_t room_ = 0;
  std::uint64_t work_ = 0;
};

inline std::uint32_t obb_node_child(const TreeView& tree, std::uint32_t node) noexcept {
  return tree.obb_nodes[node / kBlockWidth].child[node % kBlockWidth];
}

// Calls visit(lanes, lane, rows, row) for every pair of triangles, of the first and of the second tree, that the float
// tests do not tell apart, until it returns true. Precondition: both trees have triangles, and `room` suffices for
// them.
template <typename Visit>
void walk_candidates(const PlacedPair& pair, WalkStack& room, Visit&& visit) noexcept {
  const TreeView &first = pair.first.tree, &second = pair.second.tree;
  WalkPair* const stack = room.data();
  std::size_t size = 0;
  stack[size++] = {0, 0};
  BoxGaps gaps;
  while (size > 0) {
    const WalkPair top = stack[--size];
    room.spend(1);
    const std::uint32_t a = obb_node_child(first, top.a), b = obb_node_child(second, top.b);
    const ObbNodeBlock &of_a = first.obb_nodes[top.a / kBlockWidth], &of_b = second.obb_nodes[top.b / kBlockWidth];
    const std::uint32_t lane_a = top.a % kBlockWidth, lane_b = top.b % kBlockWidth;
    if (a & b & kLeafBit) {
      const TriangleBlock &lanes = first.triangle_blocks[a & ~kLeafBit], &rows = second.triangle_blocks[b & ~kLeafBit];
      const NodeBox lane_box = node_box_at(first, top.a), row_box = moved(node_box_at(second, top.b), pair.placement);
      const LeafPair leaves = {lanes, rows, lane_box, row_box};
      for (std::uint64_t left = triangle_candidates(leaves, pair.placement); left != 0; left &= left - 1) {
        const auto bit = static_cast<std::uint32_t>(std::countr_zero(left));
        room.spend(1);
        if (visit(lanes, bit % kBlockWidth, rows, bit / kBlockWidth)) return;
      }
      continue;
    }
    const bool open_second = (a & kLeafBit) != 0 ||
                             ((b & kLeafBit) == 0 && of_a.radius[lane_a] < of_b.radius[lane_b] * pair.placement.scale);
    const std::uint32_t block = open_second ? b : a;
    if (open_second) {
      meeting_boxes(moved_back(node_box_at(first, top.a), pair.placement), second.obb_nodes[block],
                    pair.placement.scale, pair.placement.box_margin, gaps);
    } else {
      meeting_boxes(moved(node_box_at(second, top.b), pair.placement), first.obb_nodes[block], 1,
                    pair.placement.box_margin, gaps);
    }
    for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
      const std::uint32_t node = block * kBlockWidth + static_cast<std::uint32_t>(std::countr_zero(left));
      if (pair.placement.coarse && boxes_are_apart(node_box_at(first, open_second ? top.a : node),
                                                   node_box_at(second, open_second ? node : top.b), pair.relative)) {
        continue;
      }
      stack[size++] = open_second ? WalkPair{top.a, node} : WalkPair{node, top.b};
    }
  }
}

}  // namespace orchard::runtime::detail
