#pragma once
#include <cstdint>
#include <limits>

#include "collision/node_pairs.h"
#include "collision/pair_budget.h"
#include "collision/placed_trees.h"
#include "orchard/runtime/distance.h"

namespace orchard::runtime {

// A DistanceQuery as the other queries of a pair see it: its public members are DistanceQuery's, and say the same.
class DistanceSearch {
 public:
  using Tolerance = DistanceQuery::Tolerance;

  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  void start(const Pose& a, const Pose& b, const Tolerance& tolerance) noexcept;
  void start_within(const Pose& a, const Pose& b, double limit) noexcept;
  void refine(const Budget& budget = {}) noexcept;

  bool finished() const noexcept { return finished_; }
  double lower() const noexcept { return lower_; }
  double upper() const noexcept { return upper_; }
  std::uint64_t work() const noexcept { return work_; }
  using Points = DistanceQuery::Points;
  Points points() const noexcept;

 private:
  struct Apart : NodePair {
    float lower;  // bound on their distance
  };

  bool has_room() const noexcept { return have_triangles(trees_) && stack_.has_room(); }
  const TreeView& first() const noexcept { return trees_.first().tree; }
  const TreeView& second() const noexcept { return trees_.second().tree; }
  void begin(const Pose& a, const Pose& b, double limit) noexcept;
  void leave_the_rest() noexcept;
  bool may_be_nearer(double lower) const noexcept;
  void expand(const detail::PlacedViews& trees, const Apart& pair) noexcept;
  void compare_leaves(const detail::PlacedViews& trees, const Apart& pair) noexcept;
  void find_within(const detail::PlacedViews& trees, const Apart& pair) noexcept;
  void compare_triangles(const TriangleBlock& lanes, std::uint32_t lane, const TriangleBlock& rows, std::uint32_t row,
                         bool may_meet) noexcept;
  void find_cut() noexcept;
  void report() noexcept;

  PlacedTrees trees_;
  detail::TreeStack<Apart> stack_;  // the nearest last
  Tolerance tolerance_;
  struct Limit {
    double length = std::numeric_limits<double>::infinity();  // what is farther is left out
    double enough = 0;                                        // so near: nothing nearer is looked for
  };
  Limit limit_;
  double cut_ = std::numeric_limits<double>::infinity();  // from the nearest and the limit, with the tolerance
  bool below_nearest_ = false;                            // what is as far is not looked at, either
  // In the first tree's units, of the stored triangles.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();  // the least found
    Vec3 on_first{}, on_second{};
    std::array<float, 3> direction{};  // unit, from the point on the first one to that on the second one
    std::uint32_t triangle_first = kNoTriangle, triangle_second = kNoTriangle;
  };
  Nearest nearest_;
  double min_lower_ = std::numeric_limits<double>::infinity();  // of everything looked at or left out
  double lower_ = 0, upper_ = std::numeric_limits<double>::infinity();
  std::uint64_t work_ = 0;
  bool finished_ = true;
};

// The search that a DistanceQuery, or a workspace's, is a cover of.
DistanceSearch& search_of(DistanceQuery& query) noexcept;

}  // namespace orchard::runtime
