#pragma once
#include <cstddef>
#include <cstdint>

#include "collision/node_pairs.h"
#include "collision/pair_budget.h"
#include "collision/placed_trees.h"

namespace orchard::runtime {

// Two triangles that meet, of the first and of the second tree.
struct MeetingTriangles {
  struct Place : NodePair {  // ball slabs of leaves, and which triangles of these
    std::uint8_t lane_a, lane_b;
  };
  Place place{};
  std::uint32_t first = kNoTriangle, second = kNoTriangle;
  Vec3 common{};  // a point of both, in the first tree's frame
};

// The last level of a pair: depth first through the two trees of triangles, the deepest overlap looked at first, so
// that a "yes" comes early. Precondition: the trees are placed.
class TriangleSearch {
 public:
  struct Tests {
    std::uint64_t pairs = 0, triangles = 0;
  };

  bool reserve(const PlacedTrees& trees) noexcept;  // false if there is no memory
  bool has_room() const noexcept { return stack_.has_room(); }
  void reset_tests() noexcept { tests_ = {}; }
  const Tests& tests() const noexcept { return tests_; }  // since then
  void forget_found() noexcept { found_.first = found_.second = kNoTriangle; }
  bool any() const noexcept { return found_.first != kNoTriangle; }
  const MeetingTriangles& found() const noexcept { return found_; }

  void start() noexcept { stack_.start({0, 0}); }  // with the roots
  // Searches up to the first pair of triangles that meet. Returns false if the budget ended the search.
  bool refine(const detail::PlacedViews& trees, PairBudget& tracker) noexcept;
  // Whether any triangles of two leaves meet.
  bool test_leaves(const detail::PlacedViews& trees, const NodePair& leaves) noexcept;
  // Whether these two meet: needs no more than relative().
  bool test_two(const detail::PlacedViews& trees, const MeetingTriangles::Place& place) noexcept;

 private:
  void push_children(const NodePair& pair, const detail::Opened& opened, const detail::BoxGaps& gaps) noexcept;

  detail::TreeStack<NodePair> stack_;  // deepest overlap last
  MeetingTriangles found_;
  Tests tests_;
};

}  // namespace orchard::runtime
