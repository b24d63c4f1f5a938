#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "collision/kernels/placement.h"
#include "collision/node_pairs.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime {

// Two trees in an order that does not depend on the order of the arguments: by their content or, if they are equal, by
// their poses. It refers to the trees, which have to live until the next bind().
class OrderedTrees {
 public:
  void bind(const PreparedTree& a, const PreparedTree& b) noexcept;
  // Orders equal trees by their poses. Returns whether the first tree is then that of `b`.
  bool order_at(const Pose& a, const Pose& b) noexcept;

  const PreparedTree& first() const noexcept { return *first_; }
  const PreparedTree& second() const noexcept { return *second_; }
  bool exchanged() const noexcept { return exchanged_; }  // whether the first tree is the second argument
  // Returns coordinate i of the centres of both roots.
  const std::array<double, 2>& roots(std::size_t i) const noexcept { return roots_[i]; }

 private:
  static const PreparedTree kNone;  // without nodes

  const PreparedTree *first_ = &kNone, *second_ = &kNone;
  std::array<std::array<double, 2>, 3> roots_{};  // the centres of both roots, by coordinate
  bool equal_ = false;                            // the trees are equal, so their poses order them
  bool one_tree_ = false;                         // both are the same tree in memory
  bool exchanged_ = false;
};

// The result of the test of two roots and of the convex hulls around the bodies. Lengths are in world units.
struct Roots {
  enum class Answer : std::uint8_t {
    apart,
    near,    // they may meet; place() can be called
    refused  // a pose is not rigid, or so far away that floats cannot hold the pair; nothing is certain
  };
  double separation_bound = std::numeric_limits<double>::infinity(), lower_bound = 0;
  Vec3 apart_along{};  // if they are apart: the direction from a to b in which they are, of length 1 up to rounding
};

// Two trees at two poses. It has the place of the second tree in the first one's frame, in double and in float, with
// margins for the rounding of the latter. Everything below the roots is computed in the units of the first tree.
class PlacedTrees {
 public:
  void bind(const PreparedTree& a, const PreparedTree& b) noexcept { trees_.bind(a, b); }

  // Tests the roots (level 0), which decides most pairs.
  Roots::Answer test_roots(const Pose& a, const Pose& b, Roots& roots) noexcept;
  // Places the trees, even if test_roots() has found them apart. Returns false if floats cannot hold the pair.
  // Precondition: test_roots() has not refused these poses.
  bool place(const Pose& a, const Pose& b) noexcept;
  // Computes only relative(), without a test of the roots; place() then does the rest. Returns false if floats cannot
  // hold the pair. Precondition: both poses are rigid.
  bool place_for_triangles(const Pose& a, const Pose& b) noexcept;
  void place() noexcept;  // places the trees after `near` or place_for_triangles()

  const PreparedTree& first() const noexcept { return trees_.first(); }
  const PreparedTree& second() const noexcept { return trees_.second(); }
  // The functions below have the precondition that the trees are placed.
  bool exchanged() const noexcept { return exchanged_; }  // whether the first tree is that of `b`
  const Pose& first_pose() const noexcept { return first_pose_; }
  const Pose& second_pose() const noexcept { return second_pose_; }
  const Pose& relative() const noexcept { return relative_; }
  const detail::Placement& placement() const noexcept { return placement_; }
  detail::PlacedViews views() const noexcept { return {first().tree, second().tree, placement_, relative_}; }
  Vec3 in_world(const Vec3& place) const noexcept {  // a point of the first tree's frame
    return transform(first_pose_, place + first().tree.origin);
  }
  // Returns a bound on the error of the place of a point in double, in world units.
  double exact_error() const noexcept { return exact_error_; }
  // Computes relative() for the poses of the last test_roots() or place_for_triangles().
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
