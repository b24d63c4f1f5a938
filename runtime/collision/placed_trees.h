#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "collision/kernels/placement.h"
#include "collision/node_pairs.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime {

// Two trees in a fixed order that does not depend on the order of the arguments: by their content or, of equal trees,
// by their poses. Refers to them: they outlive what is asked until the next bind().
class OrderedTrees {
 public:
  void bind(const PreparedTree& a, const PreparedTree& b) noexcept;
  // Orders equal trees by their poses. Returns whether the first tree is then that of `b`.
  bool order_at(const Pose& a, const Pose& b) noexcept;

  const PreparedTree& first() const noexcept { return *first_; }
  const PreparedTree& second() const noexcept { return *second_; }
  bool exchanged() const noexcept { return exchanged_; }  // whether the first tree is the second argument
  // A coordinate of both roots' centres.
  const std::array<double, 2>& roots(std::size_t i) const noexcept { return roots_[i]; }

 private:
  static const PreparedTree kNone;  // without nodes

  const PreparedTree *first_ = &kNone, *second_ = &kNone;
  std::array<std::array<double, 2>, 3> roots_{};  // of both, coordinate by coordinate
  bool equal_ = false;                            // ordered by their poses
  bool one_tree_ = false;                         // equal, and in the same place
  bool exchanged_ = false;
};

// What the roots of two trees say, and the convex hulls around these. Lengths in world units.
struct Roots {
  enum class Answer : std::uint8_t {
    apart,
    near,    // the trees are then placed as far as place() needs it
    refused  // poses that name no place, or one beyond what floats can hold: nothing is certain then
  };
  double separation_bound = std::numeric_limits<double>::infinity(), lower_bound = 0;
  Vec3 apart_along{};  // of length 1 but for rounding: from a to b, if they are apart
};

// Two trees at two poses: the second one's place in the first one's frame, in double and, with margins for its
// rounding, in float. Everything below the roots happens in the first tree's own units.
class PlacedTrees {
 public:
  void bind(const PreparedTree& a, const PreparedTree& b) noexcept { trees_.bind(a, b); }

  // Level 0, where most pairs end.
  Roots::Answer test_roots(const Pose& a, const Pose& b, Roots& roots) noexcept;
  // Places them whatever test_roots() said, unless it refused these poses. False if floats cannot hold the pair.
  bool place(const Pose& a, const Pose& b) noexcept;
  // Finds only relative(), without a look at the roots; place() does the rest. Precondition: both poses are rigid.
  bool place_for_triangles(const Pose& a, const Pose& b) noexcept;
  void place() noexcept;  // after `near`, or after place_for_triangles()

  const PreparedTree& first() const noexcept { return trees_.first(); }
  const PreparedTree& second() const noexcept { return trees_.second(); }
  // Precondition of what follows: place().
  bool exchanged() const noexcept { return exchanged_; }  // whether the first tree is that of `b`
  const Pose& first_pose() const noexcept { return first_pose_; }
  const Pose& second_pose() const noexcept { return second_pose_; }
  const Pose& relative() const noexcept { return relative_; }
  const detail::Placement& placement() const noexcept { return placement_; }
  detail::PlacedViews views() const noexcept { return {first().tree, second().tree, placement_, relative_}; }
  Vec3 in_world(const Vec3& place) const noexcept {  // a point of the first tree's frame
    return transform(first_pose_, place + first().tree.origin);
  }
  double exact_error() const noexcept { return exact_error_; }  // of a point's place in double, in the world
  // relative() at the poses kept by test_roots() or place_for_triangles().
  Pose relative_pose() const noexcept;

 private:
  void find_exact_error(const Pose& first, const Pose& second) noexcept;
  double hulls_gap(const Pose& first, const Pose& second, const Vec3& way, Vec3& u) const noexcept;
  void keep(const Pose& a, const Pose& b) noexcept;
  bool in_range() const noexcept;

  OrderedTrees trees_;
  bool exchanged_ = false;
  bool placed_ = false;  // relative_ and placement_ are those of the poses
  Pose first_pose_, second_pose_, relative_;
  double exact_error_ = 0;
  detail::Placement placement_{};
};

inline bool have_triangles(const PlacedTrees& trees) noexcept {
  return !trees.first().tree.obb_nodes.empty() && !trees.second().tree.obb_nodes.empty();
}

}  // namespace orchard::runtime
