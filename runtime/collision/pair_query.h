#pragma once
#include <cstdint>
#include <limits>

#include "collision/placed_trees.h"
#include "collision/sphere_levels.h"
#include "collision/triangle_search.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/narrow_phase.h"

namespace orchard::runtime {

// The implementation of NarrowPhase, which other queries of a pair use, too. Members that NarrowPhase also has mean the
// same.
class PairQuery {
 public:
  struct Known {
    Answer answer = Answer::maybe;
    bool finished = true, refused = true;
    double separation_bound = std::numeric_limits<double>::infinity(), lower_bound = 0;
    // After a "no" from the roots: the direction from a to b along which the bodies are lower_bound apart, of length 1
    // up to rounding. Otherwise 0.
    Vec3 apart_along{};
    std::uint64_t work = 0;
  };

  explicit PairQuery(std::size_t room = NarrowPhase::kDefaultRoom) noexcept;
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;
  bool reserve(std::size_t pairs) noexcept { return spheres_.reserve(pairs); }

  Answer start(const Pose& a, const Pose& b) noexcept;
  // Does the next level of spheres, or the last level, as far as the budget of the tracker goes. The tracker counts the
  // work.
  Answer advance(PairBudget& tracker, Order order) noexcept {
    if (known_.finished || tracker.exhausted()) return known_.answer;
    return order == Order::exact_first ? refine_last(tracker) : refine_level(tracker);
  }
  Answer refine(const Budget& budget = {}) noexcept {
    PairBudget tracker(budget);
    return advance(tracker, Order::level_by_level);
  }
  Answer refine_exactly(const Budget& budget = {}) noexcept {
    PairBudget tracker(budget);
    return advance(tracker, Order::exact_first);
  }

  const Known& known() const noexcept { return known_; }
  bool finished() const noexcept { return known_.finished; }
  NarrowPhase::Progress progress() const noexcept;
  Contact contact() const noexcept;
  Verdict verdict() const noexcept;

  PlacedTrees& trees() noexcept { return trees_; }
  bool has_last_level() const noexcept { return have_triangles(trees_) && triangles_.has_room(); }

 private:
  friend class DirectSearch;
  void reset() noexcept;
  void forget() noexcept;
  Answer refine_level(PairBudget& tracker) noexcept;
  Answer refine_last(PairBudget& tracker) noexcept;
  void start_exact() noexcept;
  void give_up_spheres() noexcept;
  void finish(Answer answer) noexcept;
  void add_ball(Contact& contact, Vec3& normal) const noexcept;
  Vec3 triangle_normal() const noexcept;

  PlacedTrees trees_;
  SphereLevels spheres_;
  TriangleSearch triangles_;
  Known known_;
  std::uint32_t level_ = 0;
  bool roots_pending_ = false;  // the levels below the roots have not begun
  bool exact_started_ = false;
  bool out_of_room_ = false;
};

// Searches the last level of a query in another order than refine_exactly(): triangles that met before come first. What
// it finds is the query's answer. Precondition: the query has a last level.
class DirectSearch {
 public:
  explicit DirectSearch(PairQuery& query) noexcept : query_(query) {}

  // Starts the query at two poses without a test of the roots. test_two() can be called then; everything else needs
  // trees().place() first. Returns false, and refuses, if floats cannot hold the pair. Precondition: both poses are
  // rigid.
  bool place(const Pose& a, const Pose& b) noexcept;
  // These test two triangles, and all triangles of two leaves. If any meet, the query's answer becomes "yes". They
  // return whether it did.
  bool test_two(const MeetingTriangles::Place& place) noexcept {
    return say_yes_if(query_.triangles_.test_two(query_.trees_.views(), place));
  }
  bool test_leaves(const NodePair& leaves) noexcept {
    return say_yes_if(query_.triangles_.test_leaves(query_.trees_.views(), leaves));
  }
  void add_work(std::uint64_t work) noexcept { query_.known_.work += work; }

  const MeetingTriangles& found() const noexcept { return query_.triangles_.found(); }

 private:
  bool say_yes_if(bool meet) noexcept;

  PairQuery& query_;
};

// Returns the implementation of a NarrowPhase.
PairQuery& query_of(NarrowPhase& pair) noexcept;

// collide() for a PairQuery, and the same without making the verdict.
Verdict collide(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;
void answer_exactly(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget,
                    Order order = Order::exact_first) noexcept;

}  // namespace orchard::runtime
