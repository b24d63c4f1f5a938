#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "orchard/runtime/execution.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"

namespace orchard::runtime {

class PairQuery;

enum class Answer : std::uint8_t {
  no,     // the surfaces do not touch: certain
  maybe,  // so far nothing excludes it
  yes     // a triangle of one meets a triangle of the other
};

// A unit of a Budget's work is a test of two spheres or two ball slabs; a test of two triangles counts as
// kTriangleTestCost. A call with work > 0 always makes progress: it exceeds the budget by less than two rows of eight
// tests or one pair of leaves (kLeafPairTests triangle tests). The clock is read once per kClockInterval tests.
inline constexpr std::uint32_t kTriangleTestCost = 2;
inline constexpr std::uint32_t kLeafPairTests = kBlockWidth * kBlockWidth;
inline constexpr std::uint64_t kClockInterval = 32;

// Where to apply a response, in world coordinates.
struct Contact {
  std::array<double, 3> center{};  // maybe: of a ball around the common part of the pair's spheres; yes: a common point
  double radius = 0;               // of that ball; 0 for yes
  std::array<double, 3> normal{};  // unit, from the first body's sphere centre to the second's: a guess
  std::uint32_t triangle_a = kNoTriangle, triangle_b = kNoTriangle;  // into each tree's triangles; yes only
};

// Everything known about a pair at one moment.
struct Verdict {
  Answer answer = Answer::maybe;
  double separation_bound = 0;  // certified upper bound on the distance between the solids; infinite while unknown
  double lower_bound = 0;       // certified lower bound on the distance between the surfaces, 0 if none is known
  Contact contact;
  std::uint32_t level = 0;  // completed levels below the roots
  std::uint64_t work = 0;   // in units of Budget::work, since start()
};

// One pair of bodies, answered level by level (dissertation 3.2, Fig. 5.4): level 0 tests the roots (and, if both have
// triangles, convex hulls around these), each further one the children of the pairs that met; the last one tests the
// triangles, exactly, through the trees of triangles.
//
// The question is whether the *surfaces* touch. A solid wholly inside another without touching is a "no":
// contains_solid() in shape_query.h answers that one.
// "No" from spheres is certain for the trees' meshes and for the triangles as stored (they differ by vertex_error).
// The last level is exact for the stored triangles, with body b's moved into a's frame in double (a relative rounding
// of about 1e-15 of the coordinates). It exists if both trees have triangles; otherwise "maybe" can be final.
//
// Preconditions: structure_fault() of both trees is nullptr, and what they view outlives this object unchanged. Poses
// that do not satisfy is_rigid() are refused (see refused()). Trees are only read: any number of objects in any number
// of threads may share them. One object belongs to one thread. Deterministic: same trees, poses, room: same answers,
// counts and bounds, however refine() was cut into pieces by budgets, on every machine and for every width of its
// vectors; and, mirrored, when a and b are exchanged. Throws nothing and allocates nothing after construction and
// reserve(). A level of spheres with more meeting pairs than there is room for is given up: out_of_room() becomes true
// and the next step is the last level, which needs none but its stack's.
// Without memory for that, "maybe" can be final, too.
class NarrowPhase {
 public:
  static constexpr std::size_t kDefaultRoom = 1u << 13;

  // Once per pair of bodies: reuse the object. O(nodes + vertices). `room`: meeting pairs per level, 24 bytes each.
  NarrowPhase(const TreeView& a, const TreeView& b, std::size_t room = kDefaultRoom) noexcept;
  // Of no bodies yet: not to be started before bind().
  explicit NarrowPhase(std::size_t room = kDefaultRoom) noexcept;
  // Of other bodies from now on, as if built from them, in some 50 ns; reserve()'s room stays. Not to be asked or
  // refined before the next start(). Allocates only if these trees are deeper than all before; false if there is no
  // memory for that: "maybe" can then be final.
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  // Room for that many meeting pairs per level. False, and nothing changed, if there is not enough memory.
  bool reserve(std::size_t pairs) noexcept;

  Answer start(const Pose& a, const Pose& b) noexcept;
  Answer refine() noexcept { return refine(Budget{}); }  // to the end of the next level
  // To the end of the next level, or of the one under way, or of the budget: resume by calling again.
  Answer refine(const Budget& budget) noexcept;
  // Leaves the levels of spheres that remain out and goes for the last one: the fastest way to "yes" or "no", without
  // the bounds on the way. Resume by calling either function again.
  Answer refine_exactly(const Budget& budget = {}) noexcept;

  // Whether any spheres meet at that level, depth first and only until two do: the fastest answer of a given accuracy,
  // "no" (certain) or "maybe", with the separation bound of those two. For after start(); refine() may follow. Budgets
  // do not interrupt it: it costs as much as the levels of spheres where the answer is "no", and far less where it is
  // not.
  Answer probe(std::uint32_t level) noexcept;

  Verdict verdict() const noexcept;
  Answer answer() const noexcept;
  bool finished() const noexcept;  // refine() has nothing left to do
  // The poses given to start() cannot be answered for: one is not rigid, or the bodies meet at a place or in a size
  // that floats cannot hold (bodies scaled beyond 4 kCoordinateLimit of the other's units, or by more than
  // kMaxRelativeScale of each other). The answer is then "maybe", finished, with the bounds 0 and infinity.
  bool refused() const noexcept;
  bool out_of_room() const noexcept;     // bounds are looser than they could be
  bool exact() const noexcept;           // the last level has begun
  std::uint32_t level() const noexcept;  // completed levels below the roots
  // That met at the last completed level of spheres; 0 once the last level has begun.
  std::size_t pairs() const noexcept;
  std::uint64_t pair_tests() const noexcept;  // of spheres and ball slabs, since start()
  std::uint64_t triangle_tests() const noexcept;
  // Since start(), as a budget counts it. A query that a time budget cut short stops at the same place again when it is
  // given this as its budget of tests: a trace of these numbers replays a run exactly.
  std::uint64_t work() const noexcept;

  // Certified upper bound on the distance between the two solids, from every pair of spheres that met so far; falls or
  // stays. (For each pair, min(e1 + e2, a1 + |c1 - c2| + a2) with e the error and a the depth of a node; 5.3.5 as
  // printed is not valid.) For an open mesh the "solid" is what its tree's bounds were computed for.
  double separation_bound() const noexcept;
  // Lower bound on the distance between the surfaces: positive after a "no" that spheres alone decided, 0 otherwise.
  double lower_bound() const noexcept;
  // The pair with the least separation bound at the last completed level; nothing after "no".
  Contact contact() const noexcept;

  NarrowPhase(NarrowPhase&&) noexcept;
  NarrowPhase& operator=(NarrowPhase&&) noexcept;
  ~NarrowPhase();

 private:
  friend PairQuery& query_of(NarrowPhase& pair) noexcept;
  const PairQuery& query() const noexcept;
  PairQuery& query() noexcept;

  // The PairQuery (a private header) lies here and not on the heap, so that its construction cannot fail.
  static constexpr std::size_t kSize = 1632, kAlignment = 32;
  alignas(kAlignment) std::array<std::byte, kSize> storage_;
};

}  // namespace orchard::runtime
