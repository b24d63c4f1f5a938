#pragma once
#include <cstddef>
#include <cstdint>

#include "collision/node_pairs.h"
#include "collision/pair_budget.h"
#include "collision/placed_trees.h"

namespace orchard::runtime {

// Two triangles that meet, of the first and of the second tree.
struct MeetingTriangles {
  struct Place : NodePair {  // two leaves, and the lanes of the triangles in them
    std::uint8_t lane_a, lane_b;
  };
  Place place{};
  std::uint32_t first = kNoTriangle, second = kNoTriangle;
  Vec3 common{};  // a point of both, in the first tree's frame
};

// The search of the last level of a pair: a depth-first walk through the triangle BVHs. The pair of nodes that overlaps
// most deeply comes first, so that a "yes" is found early. Precondition: the trees are placed.
class TriangleSearch {
 public:
  struct Tests {
    std::uint64_t pairs = 0, triangles = 0;
  };

  bool reserve(const PlacedTrees& trees) noexcept;  // false if there is no memory
  bool has_room() const noexcept { return stack_.has_room(); }
  void reset_tests() noexcept { tests_ = {}; }
  const Tests& tests() const noexcept { return tests_; }  // since reset_tests()
  void forget_found() noexcept { found_.first = found_.second = kNoTriangle; }
  bool any() const noexcept { return found_.first != kNoTriangle; }
  const MeetingTriangles& found() const noexcept { return found_; }

  void start() noexcept { stack_.start({0, 0}); }  // with the roots
  // Searches up to the first pair of triangles that meet. Returns false if the budget ended the search.
  bool refine(const detail::PlacedViews& trees, PairBudget& tracker) noexcept;
  // Returns whether any triangles of two leaves meet.
  bool test_leaves(const detail::PlacedViews& trees, const NodePair& leaves) noexcept;
  // Returns whether two triangles meet. It needs only PlacedTrees::relative().
  bool test_two(const detail::PlacedViews& trees, const MeetingTriangles::Place& place) noexcept;

 private:
  void push_children(const NodePair& pair, const detail::Opened& opened, const detail::BoxGaps& gaps) noexcept;

  detail::TreeStack<NodePair> stack_;  // the deepest overlap last
  MeetingTriangles found_;
  Tests tests_;
};

}  // namespace orchard::runtime
