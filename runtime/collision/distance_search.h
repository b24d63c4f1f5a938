#pragma once
#include <cstdint>
#include <limits>

#include "collision/node_pairs.h"
#include "collision/pair_budget.h"
#include "collision/placed_trees.h"
#include "orchard/runtime/distance.h"

namespace orchard::runtime {

// The implementation of DistanceQuery, which other queries of a pair use, too. Its public members mean the same as
// those of DistanceQuery.
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
    float lower;  // a lower bound on their distance
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
  detail::TreeStack<Apart> stack_;  // the nearest pair last
  Tolerance tolerance_;
  struct Limit {
    double length = std::numeric_limits<double>::infinity();  // pairs that are farther apart are left out
    double enough = 0;                                        // the search ends at a distance of at most this
  };
  Limit limit_;
  double cut_ =
      std::numeric_limits<double>::infinity();  // pairs with a larger lower bound are left out; see find_cut()
  bool below_nearest_ = false;                  // pairs with a lower bound of cut_ are left out, too
  // The nearest triangles so far, as they are stored, in the first tree's units.
  struct Nearest {
    double distance = std::numeric_limits<double>::infinity();
    Vec3 on_first{}, on_second{};
    std::array<float, 3> direction{};  // a unit vector from the point on the first one to that on the second one
    std::uint32_t triangle_first = kNoTriangle, triangle_second = kNoTriangle;
  };
  Nearest nearest_;
  double min_lower_ = std::numeric_limits<double>::infinity();  // the smallest bound of all pairs not on the stack
  double lower_ = 0, upper_ = std::numeric_limits<double>::infinity();
  std::uint64_t work_ = 0;
  bool finished_ = true;
};

// Returns the implementation of a DistanceQuery.
DistanceSearch& search_of(DistanceQuery& query) noexcept;

}  // namespace orchard::runtime
