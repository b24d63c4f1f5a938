#pragma once
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime {

namespace detail {

struct BlockHits;
struct TriangleBlock;

// The second tree's frame in the first one's, in float, and what to add to a sum of radii for its rounding.
struct Placement {
  std::array<float, 9> rotation;
  std::array<float, 3> translation;
  float slack;
};

// What the sphere tests of one level collect: the bits of the smallest square - reach^2 > 0, minus 1; the largest radii
// seen; and the separation bounds from which on a pair needs no look, for pairs with an inner node and for two leaves.
struct LevelState {
  alignas(32) std::array<std::uint32_t, kBlockWidth> least_excess;
  alignas(32) std::array<float, kBlockWidth> row_radius, lane_radius;
  float best_inner, best_leaf;
};

}  // namespace detail

enum class Answer : std::uint8_t {
  no,     // the surfaces do not touch: certain
  maybe,  // so far nothing excludes it
  yes     // a triangle of one meets a triangle of the other
};

// Whichever ends first. A call with pair_tests > 0 always gets somewhere: it overshoots by less than a row of eight
// sphere tests or of four triangle tests, each of which counts as kTriangleTestCost.
struct Budget {
  std::uint64_t pair_tests = std::numeric_limits<std::uint64_t>::max();
  std::chrono::nanoseconds time = std::chrono::nanoseconds::max();  // steady clock, read once per kClockInterval tests
};
inline constexpr std::uint32_t kTriangleTestCost = 16;
inline constexpr std::uint64_t kClockInterval = 64;

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

// Where to apply a response, in world coordinates.
struct Contact {
  std::array<double, 3> center{};  // maybe: of a ball around the common part of the pair's spheres; yes: a common point
  double radius = 0;               // of that ball; 0 for yes
  std::array<double, 3> normal{};  // unit, from the first body's sphere centre to the second's: a guess
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;  // into each tree's triangles; yes only
};

// One pair of bodies, answered level by level (dissertation 3.2, Fig. 5.4): level 0 tests the roots, each further one
// the children of the pairs that met; the last one tests the triangles in the leaves that met, exactly.
//
// The question is whether the *surfaces* touch. A solid wholly inside another without touching is a "no".
// "No" from spheres is certain for the trees' meshes and for the triangles as stored (they differ by vertex_error).
// The last level is exact for the stored triangles, with body b's moved into a's frame in double (a relative rounding
// of about 1e-15 of the coordinates). It exists if both trees have triangles; otherwise "maybe" can be final.
//
// Preconditions: structure_fault() of both trees is nullptr, and they outlive this object unchanged; poses are rigid.
// Trees are only read: any number of objects in any number of threads may share them. One object belongs to one thread.
// Deterministic: same trees, poses: same answers, counts and bounds, however refine() was cut into pieces by budgets,
// and, mirrored, when a and b are exchanged.
// Throws nothing. Memory grows with the number of meeting pairs and is kept for the next query: after a warm-up or
// reserve() a query allocates nothing. If memory runs out, out_of_memory() becomes true and the answer stays as it was,
// which is still valid; refine() then tries the same step again.
class NarrowPhase {
 public:
  // O(nodes + vertices) once; build the object once per pair of bodies and reuse it.
  NarrowPhase(const PackedSphereTree& a, const PackedSphereTree& b) noexcept;

  // Room for that many meeting pairs per level. False if there is not enough memory.
  bool reserve(std::size_t pairs) noexcept;

  Answer start(const Pose& a, const Pose& b) noexcept;
  Answer refine() noexcept { return refine(Budget{}); }  // to the end of the next level
  // To the end of the next level, or of the one under way, or of the budget: resume by calling again.
  Answer refine(const Budget& budget) noexcept;

  Answer answer() const noexcept { return answer_; }
  bool finished() const noexcept { return finished_; }  // refine() has nothing left to do
  bool out_of_memory() const noexcept { return out_of_memory_; }
  std::uint32_t level() const noexcept { return level_; }  // completed levels below the roots
  // That met at the last completed level.
  std::size_t pairs() const noexcept { return roots_pending_ ? 1 : inner_.size() + settled_leaves_; }
  std::uint64_t pair_tests() const noexcept { return pair_tests_; }  // of spheres, since start()
  std::uint64_t triangle_tests() const noexcept { return triangle_tests_; }

  // Certified upper bound on the distance between the two solids, from every pair of spheres that met so far; falls or
  // stays. (For each pair, min(e1 + e2, a1 + |c1 - c2| + a2) with e the error and a the depth of a node; 5.3.5 as
  // printed is not valid.) For an open mesh the "solid" is what its tree's bounds were computed for.
  double separation_bound() const noexcept { return separation_bound_; }
  // Lower bound on the distance between the surfaces: positive after a "no" that spheres alone decided, 0 otherwise.
  double lower_bound() const noexcept { return lower_bound_; }
  // The pair with the least separation bound at the last completed level; nothing after "no".
  Contact contact() const noexcept;

 private:
  struct Side {
    const PackedSphereTree* tree = nullptr;
    std::array<double, 3> root{};  // its centre, origin included
    double extent = 0;             // coordinate_extent()
  };
  struct NodePair {
    std::uint32_t a, b;
  };
  class PairList {  // a vector whose growth can fail without an exception
   public:
    bool room_for(std::size_t more) noexcept { return capacity_ - size_ >= more || reserve(size_ + more); }
    bool reserve(std::size_t capacity) noexcept;
    void push(NodePair pair) noexcept { pairs_[size_++] = pair; }
    void clear() noexcept { size_ = 0; }
    std::size_t size() const noexcept { return size_; }
    NodePair operator[](std::size_t i) const noexcept { return pairs_[i]; }

   private:
    std::unique_ptr<NodePair[]> pairs_;
    std::size_t size_ = 0, capacity_ = 0;
  };
  struct Cursor {  // where the level under way continues: lanes or second's triangles; rows or first's triangles
    std::size_t pair = 0;
    std::uint32_t outer = 0, inner = 0;
  };
  struct Best {
    double bound = std::numeric_limits<double>::infinity();
    NodePair pair{0, 0};
  };
  class Meter;

  static Side side_of(const PackedSphereTree& tree) noexcept;
  void reset() noexcept;
  void set_relative_pose(const Pose& first, const Pose& second, double exact_error) noexcept;
  bool has_triangles() const noexcept;
  void finish(Answer answer) noexcept;
  static double pair_bound(double distance, double radii, double errors, double depths) noexcept;

  bool refine_spheres(Meter& meter) noexcept;
  bool refine_triangles(Meter& meter) noexcept;
  void collect(std::uint32_t row, std::uint32_t lane, const detail::BlockHits& hits, bool lanes_are_second) noexcept;
  void improve(NodePair pair, double square, bool leaves) noexcept;
  bool settle(const detail::TriangleBlock& lanes, const detail::TriangleBlock& rows, std::uint32_t candidates) noexcept;
  void start_level() noexcept;
  void finish_sphere_level() noexcept;

  // The pair in a fixed order that does not depend on the order of the arguments: exchanged_ tells.
  Side first_, second_;
  bool ordered_by_pose_ = false;
  bool arguments_exchanged_ = false;
  bool exchanged_ = false;
  double fixed_error_ = 0;  // what does not depend on poses of the rounding in double, and the vertices' error

  // Second's frame to first's, both relative to the trees' origins; in float for spheres, in double for triangles.
  Pose first_pose_, relative_;
  detail::Placement placement_{};

  PairList inner_, leaves_, next_;  // meeting pairs: with an inner node, of two leaves, and of the level under way
  std::size_t settled_leaves_ = 0;
  Cursor cursor_;
  detail::LevelState level_state_{};
  Best level_best_, leaf_best_, best_;
  std::uint32_t triangle_first_ = kNoTriangle, triangle_second_ = kNoTriangle;
  std::array<double, 3> witness_{};

  Answer answer_ = Answer::no;
  bool finished_ = true;
  bool roots_pending_ = false;
  bool out_of_memory_ = false;
  std::uint32_t level_ = 0;
  std::uint64_t pair_tests_ = 0, triangle_tests_ = 0;
  double separation_bound_ = std::numeric_limits<double>::infinity();
  double lower_bound_ = 0;
  double pruned_gap_ = std::numeric_limits<double>::infinity();
};

}  // namespace orchard::runtime
