#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "orchard/runtime/distance.h"
#include "orchard/runtime/execution.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/shape_query.h"

// Answers whole questions about pairs of bodies in one call. The question, threads, determinism, memory and rounding
// are those of NarrowPhase. Many pairs share the memory of a query: a TreePair is a few words and takes about 50 ns to
// construct, and a Workspace, one per thread, contains what a query needs while it runs.
//
//   PreparedTree body(tree), ground(other);          // once per tree
//   Workspace workspace;                             // once per thread
//   TreePair pair(body, ground);                     // as many as there are
//   Verdict v = collide(workspace, pair, pose_a, pose_b);
//
// For many pairs at once, see share_among() in execution.h.
//
// No function here throws. None allocates memory once a workspace has been used for trees as deep as those of a pair.
namespace orchard::runtime {

// How a budget is spent.
enum class Order : std::uint8_t {
  // Tests the triangles at once. This is the fastest way to "yes" or "no"; the bounds are those of the roots.
  exact_first,
  // Tests all levels of spheres and then the triangles. The bounds on the separation are as good as the budget allows.
  level_by_level
};

// Answers a pair within a budget. To continue after the budget ended, call pair.refine_exactly(), or refine() for level
// by level. The same budget of work gives the same verdict; the Verdict::work of a timed call, passed as `work`,
// repeats it.
Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;

// Two bodies and, for collide_coherently(), the result of the last answer. It may be copied freely. The prepared trees
// must outlive it.
class TreePair {
 public:
  TreePair() = default;  // Without bodies; no query may use it.
  TreePair(const PreparedTree& a, const PreparedTree& b) noexcept : a_(&a), b_(&b) {}

  const PreparedTree& a() const noexcept { return *a_; }
  const PreparedTree& b() const noexcept { return *b_; }
  // Discards the results of earlier answers.
  void forget() noexcept { memory_ = {}; }

 private:
  friend class CoherentPair;
  // Triangles that met: ball slabs of leaves of both trees, and the lanes in these.
  struct Witness {
    std::uint32_t a, b;
    std::uint8_t lane_a, lane_b;
  };
  struct Memory {
    Pose relative;         // The pose of b in a's frame when `clearance` was certified.
    double clearance = 0;  // In a's units; 0: none.
    Witness witness;       // If they met last.
    bool met = false;
    int below_roots = 0;  // Successive searches that the roots did not decide, up to a limit.
  };
  const PreparedTree* a_ = nullptr;
  const PreparedTree* b_ = nullptr;
  Memory memory_;
};
static_assert(sizeof(TreePair) <= 256);

// The memory of queries; it belongs to one thread at a time. After collide(), `narrow` is the query that was answered
// or interrupted. It can be examined or refined further until the next call, as long as the pair's prepared trees
// exist.
class Workspace {
 public:
  // `room` is the number of meeting pairs of spheres per level, 24 bytes each, for queries that go level by level; see
  // NarrowPhase.
  explicit Workspace(std::size_t room = NarrowPhase::kDefaultRoom) noexcept;
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  NarrowPhase narrow;
  DistanceQuery distance;

  struct Scratch;               // Memory of contacts() and time_of_impact(), about 150 KB.
  Scratch* scratch() noexcept;  // Allocated at the first call; null if there is no memory.

 private:
  std::unique_ptr<Scratch> scratch_;
};

// Answers a pair as collide() does for a NarrowPhase. The answer depends only on trees, poses and budget.
Verdict collide(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;

// Answers a pair that is queried repeatedly while it moves a little each time, at a fraction of the cost. The triangles
// that met last are tested first, and a "no" holds as long as the pair, measured at its farthest point, has moved by
// less than the clearance that was certified with it.
// "Yes" and "no" are those of collide() without a budget. If several triangles meet, which ones are named depends on
// earlier calls, and so do bounds and work. If no search is necessary, the workspace does not change.
Verdict collide_coherently(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept;

// Returns whether the distance of the surfaces is at most `margin` (world units, at least 0). "No" and "yes" are
// certain. "Maybe" is the answer if rounding does not decide: within about 1e-12 of the coordinates, and for triangles
// with nearly parallel edges within 2e-7 of these. It is also the answer for poses that NarrowPhase refuses, for a
// margin that is NaN or negative, and if a tree has no triangles. Costs about as much as collide(), and up to twice
// that for margins far larger than triangles.
// A budget that ends first makes "maybe" of what is not known by then. The work is that of workspace.narrow if the
// margin is 0, otherwise that of workspace.distance.
Answer closer_than(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, double margin,
                   const Budget& budget = {}) noexcept;

// The distance between two surfaces by DistanceQuery, and the nearest points.
struct Distance {
  double lower = 0, upper = std::numeric_limits<double>::infinity();  // lower <= distance <= upper.
  DistanceQuery::Points points;
};
// Computes the distance between two surfaces to the given tolerance.
Distance distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const DistanceQuery::Tolerance& tolerance = {}) noexcept;

// The result of closer_with_points().
struct Closeness {
  Answer answer = Answer::maybe;
  Distance distance;  // For "yes" only.
};
// Does the same as closer_than() and, for "yes", also returns a point of each surface, at most `margin` apart up to
// rounding. This costs an additional distance query.
Closeness closer_with_points(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                             double margin) noexcept;

}  // namespace orchard::runtime
