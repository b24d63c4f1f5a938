#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "collision/node_pairs.h"
#include "math/vector_functions.h"
#include "orchard/runtime/packed_tree.h"

// A depth-first walk through the triangle BVHs of a pair, to every pair of triangles that meet.
namespace orchard::runtime::detail {

// Two trees, of which the second one is placed in the first one's frame. Both frames are relative to the trees'
// origins.
struct PlacedPair {
  const PreparedTree &first, &second;
  Pose relative;
  Placement placement;

  // Returns the pair with the second tree moved by `by`, in the first one's units.
  PlacedPair moved(const Vec3& by) const noexcept {
    PlacedPair result = *this;
    const double size = one_norm(by);
    for (std::size_t i = 0; i < 3; ++i) {
      result.relative.translation[i] += by[i];
      result.placement.translation[i] = static_cast<float>(result.relative.translation[i]);
    }
    // A margin has at most 108 u for each unit of the translation's length, or 204 u (placed_trees.cpp).
    result.placement.margin += static_cast<float>(size * 0x1p-17);
    result.placement.box_margin += static_cast<float>(size * 0x1p-16);
    return result;
  }
};

// The stack of a walk, and a count of its work.
struct WalkStack {
  TreeStack<NodePair> stack;
  std::uint64_t work =
      0;  // The number of pairs of nodes opened, pairs of leaves tested, and pairs of triangles visited.
};

// Calls visit(lanes, lane, rows, row) for every pair of triangles that the tests in float do not separate, until it
// returns true. `lanes` is a block of the first tree, and `rows` is one of the second. Preconditions: both trees have
// triangles, and room.stack.reserve() has been called for them.
template <typename Visit>
void walk_candidates(const PlacedPair& pair, WalkStack& room, const Visit& visit) noexcept {
  const PlacedViews trees = {pair.first.tree, pair.second.tree, pair.placement, pair.relative};
  BoxGaps gaps;
  for (room.stack.start({0, 0}); !room.stack.empty();) {
    const NodePair top = room.stack.pop();
    ++room.work;
    if (!trees.are_leaves(top)) {
      const Opened opened = trees.open(top);
      trees.meeting_children(top, opened, gaps);
      for (std::uint32_t left = gaps.meeting; left != 0; left &= left - 1) {
        room.stack.push(opened.pair(top, static_cast<std::uint32_t>(std::countr_zero(left))));
      }
      continue;
    }
    const TriangleBlock &lanes = trees.lanes(top), &rows = trees.rows(top);
    const auto take = [&](std::uint32_t lane, std::uint32_t row) {
      ++room.work;
      return visit(lanes, lane, rows, row);
    };
    if (trees.each_candidate(top, take)) return;
  }
}

}  // namespace orchard::runtime::detail
