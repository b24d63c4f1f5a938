#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "orchard/runtime/distance.h"
#include "orchard/runtime/execution.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pair_front.h"
#include "orchard/runtime/shape_query.h"

// A whole question in one call. What NarrowPhase says about the question answered, threads, determinism and memory
// holds here.
namespace orchard::runtime {

// How a budget is spent.
enum class Order : std::uint8_t {
  exact_first,    // straight to the triangles: the fastest way to "yes" or "no"; bounds are those of the roots
  level_by_level  // all levels of spheres, then the triangles: bounds on the separation as good as the budget allows
};

// Answers a pair within a budget. What a budget ends can be gone on with: pair.refine_exactly(), or refine() for level
// by level. The same budget of tests gives the same verdict; Verdict::work of a timed call, given as `work`,
// repeats it.
Verdict collide(NarrowPhase& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;

// Many pairs of bodies, cheaply: a TreePair is a few words and is made in some 50 ns; what a query needs while it runs
// is in a Workspace, one per thread, which all pairs share.
//
//   PreparedTree body(tree), ground(other);          // once per tree
//   Workspace workspace;                             // once per thread
//   TreePair pair(body, ground);                     // as many as there are
//   Verdict v = collide(workspace, pair, pose_a, pose_b);
//
// What NarrowPhase says about the question answered, poses, determinism and rounding holds here. Nothing here throws,
// and nothing allocates once a workspace has seen trees as deep as those of a pair.

// Two bodies that may be asked about, and, for collide_coherently(), what the last answer said. Free to copy. The
// prepared trees outlive it.
class TreePair {
 public:
  TreePair() = default;  // of nothing: not to be asked about
  TreePair(const PreparedTree& a, const PreparedTree& b) noexcept : a_(&a), b_(&b) {}

  const PreparedTree& a() const noexcept { return *a_; }
  const PreparedTree& b() const noexcept { return *b_; }
  // From now on collide_coherently() begins where it ended before, and keeps in `front` where that is: for pairs that
  // stay close. Null: no more. The front outlives the pair, its copies share it, and only one of them is asked at a
  // time.
  void use(PairFront* front) noexcept {
    front_ = front;
    if (front != nullptr) front->clear();
  }
  void forget() noexcept {  // as if never asked before
    memory_ = {};
    if (front_ != nullptr) front_->clear();
  }

 private:
  friend struct Coherence;
  static constexpr std::size_t kWitnesses = 2;
  struct Witness {  // triangles that met: ball slabs of leaves of both trees, and which of these
    std::uint32_t a, b;
    std::uint8_t lane_a, lane_b;
  };
  struct Memory {
    Pose relative;                              // of b in a's frame, when `clearance` was certified
    double clearance = 0;                       // in a's units; 0: none
    std::array<Witness, kWitnesses> witnesses;  // in the answers since the last "no", the last ones first
    std::uint8_t witness_count = 0;
    std::uint8_t wait = 0;     // searches until the roots are asked first
    std::uint8_t in_vain = 0;  // times that the roots were asked and told nothing, in a row
    bool close = false;        // the roots did not decide the last search
  };
  const PreparedTree* a_ = nullptr;
  const PreparedTree* b_ = nullptr;
  PairFront* front_ = nullptr;
  Memory memory_;
};
static_assert(sizeof(TreePair) <= 256);

// What queries work with: belongs to one thread at a time. After collide() its `narrow` is the query that was answered
// or interrupted, to be looked at or refined further, until the next call: as long as the pair's prepared trees exist.
class Workspace {
 public:
  // `room`: meeting pairs of spheres per level, 24 bytes each, for queries that go level by level; see NarrowPhase.
  explicit Workspace(std::size_t room = NarrowPhase::kDefaultRoom) noexcept;
  ~Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;

  NarrowPhase narrow;
  DistanceQuery distance;

  struct Scratch;               // of contacts() and time_of_impact(), some 100 KB
  Scratch* scratch() noexcept;  // made when first asked for; null: there is no memory

 private:
  std::unique_ptr<Scratch> scratch_;
};

// As collide() for a NarrowPhase. The answer depends on nothing but trees, poses and budget.
Verdict collide(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;

// The same answer for a pair that is asked about again and again while it moves a little each time, at a fraction of
// the cost: the triangles that met last are tried first, and a "no" holds as long as the pair has moved less, its
// farthest point counted, than the clearance that was certified with it. With a front (TreePair::use()), what is looked
// at besides begins where the last search ended. Yes and no are those of collide() without a
// budget; where several triangles meet, which ones are named, and bounds and work, depend on what was asked before.
// Where nothing has to be looked at, the workspace stays as it is.
Verdict collide_coherently(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept;

// Whether the surfaces are closer to each other than `margin` (in world units, at least 0; at most that far, exactly),
// at about the cost of collide(), up to twice that for margins far larger than triangles. "No" and "yes" are certain.
// "Maybe" is the answer where rounding does not tell: within some 1e-12 of the coordinates, and for triangles with
// nearly parallel edges within 2e-7 of these; for what NarrowPhase refuses, for a margin that is not a number or
// negative, and where a tree has no triangles.
Answer closer_than(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, double margin) noexcept;

// The distance between the surfaces, by DistanceQuery, and where they are nearest.
struct Distance {
  double lower = 0, upper = std::numeric_limits<double>::infinity();  // lower <= distance <= upper
  DistanceQuery::Points points;
};
Distance distance(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                  const DistanceQuery::Tolerance& tolerance = {}) noexcept;

// closer_than() with witnesses: where the answer is "yes", a point of each surface, at most `margin` apart but for
// rounding. Costs a distance query more there.
struct Closeness {
  Answer answer = Answer::maybe;
  Distance distance;  // for "yes"
};
Closeness closer_with_points(Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b,
                             double margin) noexcept;

// Many questions in one call, on as many threads as the executor has. Every answer is the one that the single call
// gives: it depends neither on the executor nor on the other questions. `workspaces`: at least one; as many jobs run as
// there are workspaces, so give executor.concurrency of them. Spans of results are as long as those of questions.
// Nothing here throws or allocates.

// Poses as arrays of their parts, as simulations keep them: element i of each. An empty `scale` means 1.
struct PoseArrays {
  std::span<const std::array<double, 9>> rotation;
  std::span<const std::array<double, 3>> translation;
  std::span<const double> scale;

  std::size_t size() const noexcept { return translation.size(); }
  Pose operator[](std::size_t i) const noexcept { return {rotation[i], translation[i], scale.empty() ? 1 : scale[i]}; }
};

// Pair i of trees with pose i of a and of b; one pair of trees is asked about at all poses.
void collide(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
             const PoseArrays& a, const PoseArrays& b, std::span<Verdict> verdicts, const Budget& each = {}) noexcept;
// Distances, and closer_than() with one margin.
void distance(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
              const PoseArrays& a, const PoseArrays& b, std::span<Distance> distances,
              const DistanceQuery::Tolerance& tolerance = {}) noexcept;
void closer_than(std::span<Workspace> workspaces, const Executor& executor, std::span<const TreePair> pairs,
                 const PoseArrays& a, const PoseArrays& b, double margin, std::span<Answer> answers) noexcept;

}  // namespace orchard::runtime
