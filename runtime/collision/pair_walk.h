#pragma once
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "collision/kernels/node_box.h"
#include "collision/kernels/obb_node_block.h"
#include "collision/node_pairs.h"
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
    // A margin has at most 108 u for each unit of the translation's length, or 204 u (placed_trees.cpp).
    result.placement.margin += static_cast<float>(size * 0x1p-17);
    result.placement.box_margin += static_cast<float>(size * 0x1p-16);
    return result;
  }
};

class WalkStack {
 public:
  // Room for two trees. False if there is no memory.
  bool reserve(const TreeView& a, const TreeView& b) noexcept { return stack_.reserve(a, b); }
  NodePair* data() const noexcept { return stack_.data(); }
  // The tests of eight against one, of leaves, and visits to triangles so far.
  std::uint64_t work() const noexcept { return work_; }
  void spend(std::uint64_t tests) noexcept { work_ += tests; }

 private:
  TreeStack<NodePair> stack_;
  std::uint64_t work_ = 0;
};

// Calls visit(lanes, lane, rows, row) for every pair of triangles, of the first and of the second tree, that the float
// tests do not tell apart, until it returns true. Precondition: both trees have triangles, and `room` suffices for
// them.
template <typename Visit>
void walk_candidates(const PlacedPair& pair, WalkStack& room, Visit&& visit) noexcept {
  const TreeView &first = pair.first.tree, &second = pair.second.tree;
  NodePair* const stack = room.data();
  std::size_t size = 0;
  stack[size++] = {0, 0};
  BoxGaps gaps;
  while (size > 0) {
    const NodePair top = stack[--size];
    room.spend(1);
    const std::uint32_t a = slab_child(first, top.a), b = slab_child(second, top.b);
    if (a & b & kLeafBit) {
      const TriangleBlock &lanes = first.triangle_blocks[a & ~kLeafBit], &rows = second.triangle_blocks[b & ~kLeafBit];
      const NodeBox lane_box = node_box_at(first, top.a), row_box = moved(node_box_at(second, top.b), pair.placement);
      const LeafPair leaves = {lanes, rows, lane_box, row_box};
      const auto take = [&](std::uint32_t lane, std::uint32_t row) {
        room.spend(1);
        return visit(lanes, lane, rows, row);
      };
      if (each_candidate(leaves, pair.placement, take)) return;
      continue;
    }
    const Opened opened = larger_node(first, second, top, a, b, pair.placement.scale);
    meeting_children(first, second, pair.placement, pair.relative, top, opened, gaps);
    for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
      stack[size++] = opened.pair(top, static_cast<std::uint32_t>(std::countr_zero(left)));
    }
  }
}

}  // namespace orchard::runtime::detail
