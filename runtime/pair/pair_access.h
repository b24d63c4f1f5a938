#pragma once
#include <limits>

#include "orchard/runtime/narrow_phase.h"

namespace orchard::runtime {

// What the queries about a pair besides NarrowPhase itself use of it: the bodies' order, their placement in each
// other's frame, and what covers its rounding.
struct PairAccess {
  using BudgetTracker = NarrowPhase::BudgetTracker;

  // Prepares for queries in the first tree's frame, whatever the roots say. False where nothing can be said.
  static bool place(NarrowPhase& pair, const Pose& a, const Pose& b) noexcept {
    pair.start(a, b);
    if (pair.refused_) return false;
    pair.keep(a, b);
    if (!pair.in_range()) return false;
    pair.place();
    return true;
  }
  // The same without a look at the roots. Precondition: both poses are rigid.
  static bool place_only(NarrowPhase& pair, const Pose& a, const Pose& b) noexcept {
    pair.reset_counts();
    pair.find_exact_error(pair.arguments_exchanged_ ? b : a, pair.arguments_exchanged_ ? a : b);
    pair.separation_bound_ = std::numeric_limits<double>::infinity();
    pair.keep(a, b);
    if (!pair.in_range()) return false;
    pair.refused_ = false;
    pair.place();
    return true;
  }
  // Precondition of what follows: place() gave true.
  static const PreparedTree& first(const NarrowPhase& pair) noexcept { return pair.first_; }
  static const PreparedTree& second(const NarrowPhase& pair) noexcept { return pair.second_; }
  static const Pose& first_pose(const NarrowPhase& pair) noexcept { return pair.first_pose_; }
  static const Pose& second_pose(const NarrowPhase& pair) noexcept { return pair.second_pose_; }
  static const Pose& relative(const NarrowPhase& pair) noexcept { return pair.relative_; }
  static const detail::Placement& placement(const NarrowPhase& pair) noexcept { return pair.placement_; }
  static bool exchanged(const NarrowPhase& pair) noexcept { return pair.exchanged_; }
  static double exact_error(const NarrowPhase& pair) noexcept { return pair.exact_error_; }  // in the world
  // That these triangles, of the first and of the second tree, meet, was found out without the pair.
  static void say_yes(NarrowPhase& pair, std::uint32_t first, std::uint32_t second,
                      const std::array<double, 3>& witness) noexcept {
    pair.exact_started_ = true;
    pair.triangle_first_ = first, pair.triangle_second_ = second;
    pair.witness_ = witness;
    pair.finish(Answer::yes);
  }
  static bool has_triangles(const NarrowPhase& pair) noexcept { return pair.has_triangles(); }
};

}  // namespace orchard::runtime
