#pragma once
#include <algorithm>
#include <limits>

#include "orchard/runtime/narrow_phase.h"
#include "tree/ball_slab_block.h"

namespace orchard::runtime {

// What the queries about a pair besides NarrowPhase itself use of it: the bodies' order, their placement in each
// other's frame, and what covers its rounding.
struct PairAccess {
  using BudgetTracker = NarrowPhase::BudgetTracker;
  using NodePair = NarrowPhase::NodePair;

  // NarrowPhase::bind() where the prepared trees outlive what is asked until the next one: nothing is copied.
  static bool bind(NarrowPhase& pair, const PreparedTree& a, const PreparedTree& b) noexcept {
    return pair.bind_where(a, b);
  }

  // Prepares for queries in the first tree's frame, whatever the roots say. False where nothing can be said.
  static bool place(NarrowPhase& pair, const Pose& a, const Pose& b) noexcept {
    pair.start(a, b);
    if (pair.refused_) return false;
    pair.keep(a, b);
    if (!pair.in_range()) return false;
    pair.place();
    return true;
  }
  // The same without a look at the roots, and only as far as test_two() needs it: place_now() does the
  // rest. Precondition: both poses are rigid.
  static bool place_for_triangles(NarrowPhase& pair, const Pose& a, const Pose& b) noexcept {
    pair.reset_counts();
    pair.find_exact_error(pair.arguments_exchanged_ ? b : a, pair.arguments_exchanged_ ? a : b);
    pair.separation_bound_ = std::numeric_limits<double>::infinity();
    pair.keep(a, b);
    if (!pair.in_range()) return false;
    pair.refused_ = pair.finished_ = false;
    pair.answer_ = Answer::maybe;
    pair.relative_ = pair.relative_pose();
    return true;
  }
  // After that, or after start() that has left the bodies to deeper levels.
  static void place_now(NarrowPhase& pair) noexcept { pair.place(); }
  // Precondition of what follows: place() gave true.
  static const PreparedTree& first(const NarrowPhase& pair) noexcept { return *pair.first_; }
  static const PreparedTree& second(const NarrowPhase& pair) noexcept { return *pair.second_; }
  static const Pose& first_pose(const NarrowPhase& pair) noexcept { return pair.first_pose_; }
  static const Pose& second_pose(const NarrowPhase& pair) noexcept { return pair.second_pose_; }
  static const Pose& relative(const NarrowPhase& pair) noexcept { return pair.relative_; }
  static const detail::Placement& placement(const NarrowPhase& pair) noexcept { return pair.placement_; }
  static bool exchanged(const NarrowPhase& pair) noexcept { return pair.exchanged_; }
  static double exact_error(const NarrowPhase& pair) noexcept { return pair.exact_error_; }  // in the world
  using Place = NarrowPhase::Place;
  // Whether these triangles of the first and of the second tree meet, by the test of the last level: then that is said.
  static bool test_two(NarrowPhase& pair, const Place& p) noexcept {
    return say_yes_if(pair, pair.test_two(p.first, p.lane_first, p.second, p.lane_second));
  }
  // The same of all triangles of two leaves.
  static bool test_leaves(NarrowPhase& pair, std::uint32_t first, std::uint32_t second) noexcept {
    return say_yes_if(pair, pair.test_triangles({first, second}));
  }
  // The same of what is beside these leaves in the trees, but for the leaves themselves, as far as the budget goes.
  static bool search_near(NarrowPhase& pair, std::uint32_t first, std::uint32_t second, const Budget& budget) noexcept {
    return pair.refine_near(first, second, budget);
  }
  static bool exact_started(const NarrowPhase& pair) noexcept { return pair.exact_started_; }
  static const Place& meeting(const NarrowPhase& pair) noexcept { return pair.meeting_; }  // after "yes"
  // All of the last level.
  static void search(NarrowPhase& pair, const Budget& budget) noexcept { pair.refine_last(budget); }
  // That none do, and how far apart they are at least, in the world.
  static void say_no(NarrowPhase& pair, double lower) noexcept {
    pair.exact_started_ = true;
    pair.finish(Answer::no);
    pair.lower_bound_ = lower;
  }
  // After a "no" of the roots: the direction from a to b along which the bodies are lower_bound() apart, of length 1
  // but for rounding. Else 0.
  static std::array<double, 3> apart_along(const NarrowPhase& pair) noexcept {
    const auto& u = pair.apart_along_;
    return pair.arguments_exchanged_ ? std::array<double, 3>{-u[0], -u[1], -u[2]} : u;
  }
  static void add_work(NarrowPhase& pair, std::uint64_t work) noexcept { pair.work_ += work; }
  static bool has_last_level(const NarrowPhase& pair) noexcept { return pair.has_last_level(); }
  static NodePair* stack(const NarrowPhase& pair) noexcept { return pair.stack_.get(); }
  static bool has_triangles(const NarrowPhase& pair) noexcept { return pair.has_triangles(); }

 private:
  static bool say_yes_if(NarrowPhase& pair, bool meet) noexcept {
    if (!meet) return false;
    pair.exact_started_ = true;
    pair.finish(Answer::yes);
    return true;
  }
};

// collide() with Order::exact_first, but for the verdict.
void answer_exactly(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget) noexcept;

}  // namespace orchard::runtime
