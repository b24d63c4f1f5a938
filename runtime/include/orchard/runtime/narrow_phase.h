#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "orchard/runtime/execution.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

// The narrow phase: whether two bodies touch, answered level by level with certified bounds.
namespace orchard::runtime {

class PairQuery;

// The answer to a question about two bodies.
enum class Answer : std::uint8_t {
  no,     // The surfaces do not touch; this is certain.
  maybe,  // Nothing excludes a contact so far.
  yes     // A triangle of one body meets a triangle of the other.
};

// The work of a test of two triangles. A unit of a Budget's work is a test of two spheres or two ball slabs. A call
// with work > 0 always makes progress: it exceeds the budget by less than two rows of eight tests or one pair of leaves
// (kLeafPairTests triangle tests). The clock is read once per kClockInterval tests.
inline constexpr std::uint32_t kTriangleTestCost = 2;
inline constexpr std::uint32_t kLeafPairTests = kBlockWidth * kBlockWidth;
inline constexpr std::uint64_t kClockInterval = 32;

// The place where a response applies, in world coordinates.
struct Contact {
  // For "maybe", the centre of a ball around the common part of the pair's spheres; for "yes", a common point.
  std::array<double, 3> center{};
  double radius = 0;  // The radius of that ball; 0 for "yes".
  // A unit vector from the centre of the first body's sphere to that of the second's. It is a guess.
  std::array<double, 3> normal{};
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;  // The triangles that meet, for "yes" only.
};

// Everything known about a pair at one moment. Lengths are in world units.
struct Verdict {
  Answer answer = Answer::maybe;
  // A certified upper bound on the distance between the solids; infinite while unknown.
  double separation_bound = 0;
  // A certified lower bound on the distance between the surfaces; 0 if none is known.
  double lower_bound = 0;
  Contact contact{};
  std::uint32_t level = 0;  // Completed levels below the roots.
  std::uint64_t work = 0;   // Since start(), in units of Budget::work.
};

// One pair of bodies, answered level by level (dissertation 3.2, Fig. 5.4). Level 0 tests the roots, and convex hulls
// around them if both trees have triangles. Each further level tests the children of the pairs that met. The last level
// tests the triangles, exactly, through the triangle BVHs.
//
// The question is whether the *surfaces* touch. A solid wholly inside another without touching it gives "no";
// contains_solid() in shape_query.h answers that case. "No" from spheres is certain for the trees' meshes and for the
// triangles as stored (they differ by vertex_error). The last level is exact for the stored triangles, with those of
// body b moved into a's frame in double (a relative rounding of about 1e-15 of the coordinates). It exists if both
// trees have triangles; otherwise "maybe" can be final.
//
// Preconditions: structure_fault() of both trees is nullptr, and what they view outlives this object unchanged. Poses
// that do not satisfy is_rigid() are refused (see refused()). Trees are only read, so any number of objects in any
// number of threads may share them. One object must not be used by several threads at once.
//
// The object is deterministic: the same trees, poses and room give the same answers, counts and bounds, however budgets
// divide the calls of refine(), on every machine and for every vector width; exchanging a and b mirrors the results. It
// throws nothing, and allocates nothing after construction and reserve(). If a level of spheres has more meeting pairs
// than there is room for, it is abandoned: Progress::out_of_room becomes true, and the next step is the last level,
// which needs only the memory of its stack. Without memory for that, "maybe" can be final, too.
class NarrowPhase {
 public:
  static constexpr std::size_t kDefaultRoom = 1u << 13;

  // Constructs a query without bodies. Call bind() before start(). `room` is the number of meeting pairs per level, 24
  // bytes each.
  explicit NarrowPhase(std::size_t room = kDefaultRoom) noexcept;
  // Constructs the query of a pair. The prepared trees must outlive the query or its next bind(). Reuse the object for
  // all poses, and for other pairs by bind().
  NarrowPhase(const PreparedTree& a, const PreparedTree& b, std::size_t room = kDefaultRoom) noexcept
      : NarrowPhase(room) {
    bind(a, b);
  }
  // Rebinds the query to another pair (about 10 ns) and keeps reserved memory. The prepared trees must outlive the
  // query or its next bind(). Call start() before the next query. Allocates only if these trees are deeper than all
  // before. Returns false if there is no memory for that; "maybe" can then be final.
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  // Reserves room for this many meeting pairs per level. Returns false and changes nothing if there is not enough
  // memory.
  bool reserve(std::size_t pairs) noexcept;

  // Starts the query at two poses with level 0.
  Answer start(const Pose& a, const Pose& b) noexcept;
  // Refines to the end of the current or next level, or of the budget. Call it again to continue.
  Answer refine(const Budget& budget = {}) noexcept;
  // Skips the remaining levels of spheres and refines the last level: the fastest way to "yes" or "no", without the
  // bounds of the levels in between. Call either function again to continue.
  Answer refine_exactly(const Budget& budget = {}) noexcept;

  Verdict verdict() const noexcept;
  Answer answer() const noexcept;
  bool finished() const noexcept;  // Whether refine() has nothing left to do.
  // Returns whether the poses of start() cannot be answered: one is not rigid, or the bodies meet at a place or in a
  // size that floats cannot represent (bodies scaled beyond 4 kCoordinateLimit of the other's units, or by more than
  // kMaxRelativeScale of each other). The answer is then "maybe", finished, with the bounds 0 and infinity.
  bool refused() const noexcept;

  // How far a query has come since start().
  struct Progress {
    std::uint32_t level;       // Completed levels below the roots.
    bool exact;                // Whether the last level has begun.
    bool out_of_room;          // Whether bounds are looser because room was missing.
    std::size_t pairs;         // Pairs that met at the last completed level of spheres; 0 once the last has begun.
    std::uint64_t pair_tests;  // Tests of spheres and ball slabs.
    std::uint64_t triangle_tests;
    // In units of a budget. A query that a time budget cut short stops at the same place again if it gets this value as
    // its budget of work, so a trace of these values replays a run exactly.
    std::uint64_t work;
  };
  Progress progress() const noexcept;

  // Returns a certified upper bound on the distance between the two solids, from every pair of spheres that met so far.
  // It never rises. For each pair it is min(e1 + e2, a1 + |c1 - c2| + a2), where e is the error and a the depth of a
  // node; formula 5.3.5 as printed is not valid. For an open mesh, the "solid" is what the bounds of its tree were
  // computed for.
  double separation_bound() const noexcept;
  // Returns a lower bound on the distance between the surfaces: positive after a "no" that spheres alone decided,
  // otherwise 0.
  double lower_bound() const noexcept;
  // Returns the pair with the smallest separation bound at the last completed level; nothing after "no".
  Contact contact() const noexcept;

  NarrowPhase(NarrowPhase&&) noexcept;
  NarrowPhase& operator=(NarrowPhase&&) noexcept;
  ~NarrowPhase();

 private:
  friend PairQuery& query_of(NarrowPhase& pair) noexcept;
  const PairQuery& query() const noexcept;
  PairQuery& query() noexcept;

  // The PairQuery (a private header) lies here and not on the heap, so that its construction cannot fail.
  static constexpr std::size_t kSize = 1120, kAlignment = 32;
  alignas(kAlignment) std::array<std::byte, kSize> storage_;
};

}  // namespace orchard::runtime
