#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>

#include "orchard/runtime/budget.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "orchard/runtime/prepared_tree.h"

namespace orchard::runtime {

namespace detail {

struct BlockHits;
struct BoxGaps;
struct NodeBox;

// The second tree's frame in the first one's, in float, and what covers the rounding.
struct Placement {
  std::array<float, 9> rotation;  // times scale
  std::array<float, 9> turn;      // without
  std::array<float, 3> translation;
  float scale;
  float slack;           // to add to a sum of radii
  float margin;          // to take from a gap between ball slabs
  float unit = 1;        // a power of two: times this, every coordinate of the pair's frame is at most 1
  float whole = 1;       // 1 / unit
  float box_margin = 0;  // to take from a gap between boxes
  // `box_margin` is large beside the smaller body, since the other one is larger by far or its origin far away: boxes
  // that floats do not separate are tested in double.
  bool coarse = false;
  // Of `turn` again, by fours: find_rows().
  alignas(16) std::array<std::array<float, 4>, 3> rows{}, columns{};
};

// One ball slab, in the first tree's frame.
struct BallSlab {
  float x, y, z, nx, ny, nz, radius, height;
};

// What the sphere tests of one level collect: the bits of the smallest square - reach^2 > 0, minus 1; the largest radii
// seen; and the separation bounds from which on a pair needs no test, for pairs with an inner node and for two leaves.
struct LevelState {
  alignas(32) std::array<std::uint32_t, kBlockWidth> min_excess;
  alignas(32) std::array<float, kBlockWidth> row_radius, lane_radius;
  float best_inner, best_leaf;
};

}  // namespace detail

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
  // Of other bodies from now on, as if made anew of them, in some 50 ns; reserve()'s room stays. Not to be asked or
  // refined before the next start(). Allocates only if these trees are deeper than all before; false if there is no
  // memory for that: "maybe" can then be final.
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;

  // Room for that many meeting pairs per level. False, and nothing changed, if there is not enough memory.
  bool reserve(std::size_t pairs) noexcept;

  Answer start(const Pose& a, const Pose& b) noexcept;
  Answer refine() noexcept { return refine(Budget{}); }  // to the end of the next level
  // To the end of the next level, or of the one under way, or of the budget: resume by calling again.
  Answer refine(const Budget& budget) noexcept { return finished_ ? answer_ : refine_level(budget); }
  // Leaves the levels of spheres that remain out and goes for the last one: the fastest way to "yes" or "no", without
  // the bounds on the way. Resume by calling either function again.
  Answer refine_exactly(const Budget& budget = {}) noexcept { return finished_ ? answer_ : refine_last(budget); }

  // Whether any spheres meet at that level, depth first and only until two do: the fastest answer of a given accuracy,
  // "no" (certain) or "maybe", with the separation bound of those two. For after start(); refine() may follow. Budgets
  // do not interrupt it: it costs as much as the levels of spheres where the answer is "no", and far less where it is
  // not.
  Answer probe(std::uint32_t level) noexcept;

  Verdict verdict() const noexcept;
  Answer answer() const noexcept { return answer_; }
  bool finished() const noexcept { return finished_; }  // refine() has nothing left to do
  // The poses given to start() cannot be answered for: one is not rigid, or the bodies meet at a place or in a size
  // that floats cannot hold (bodies scaled beyond 4 kCoordinateLimit of the other's units, or by more than
  // kMaxRelativeScale of each other). The answer is then "maybe", finished, with the bounds 0 and infinity.
  bool refused() const noexcept { return refused_; }
  bool out_of_room() const noexcept { return out_of_room_; }  // bounds are looser than they could be
  bool exact() const noexcept { return exact_started_; }      // the last level has begun
  std::uint32_t level() const noexcept { return level_; }     // completed levels below the roots
  // That met at the last completed level of spheres; 0 once the last level has begun.
  std::size_t pairs() const noexcept { return roots_pending_ ? 1 : inner_.size() + settled_leaves_; }
  std::uint64_t pair_tests() const noexcept { return pair_tests_; }  // of spheres and ball slabs, since start()
  std::uint64_t triangle_tests() const noexcept { return triangle_tests_; }
  // Since start(), as a budget counts it. A query that a time budget cut short stops at the same place again when it is
  // given this as its budget of tests: a trace of these numbers replays a run exactly.
  std::uint64_t work() const noexcept { return work_; }

  // Certified upper bound on the distance between the two solids, from every pair of spheres that met so far; falls or
  // stays. (For each pair, min(e1 + e2, a1 + |c1 - c2| + a2) with e the error and a the depth of a node; 5.3.5 as
  // printed is not valid.) For an open mesh the "solid" is what its tree's bounds were computed for.
  double separation_bound() const noexcept { return separation_bound_; }
  // Lower bound on the distance between the surfaces: positive after a "no" that spheres alone decided, 0 otherwise.
  double lower_bound() const noexcept { return lower_bound_; }
  // The pair with the least separation bound at the last completed level; nothing after "no".
  Contact contact() const noexcept;

 private:
  friend class DistanceQuery;
  friend struct PairAccess;  // the other queries of runtime/pair
  using Side = PreparedTree;
  class BoundSide {  // in the caller's place, or a copy
   public:
    BoundSide() noexcept = default;
    BoundSide(const BoundSide& other) noexcept : own_(other.own_), at_(other.owns() ? &own_ : other.at_) {}
    BoundSide& operator=(const BoundSide& other) noexcept {
      if (this == &other) return *this;
      own_ = other.own_;
      at_ = other.owns() ? &own_ : other.at_;
      return *this;
    }
    void copy(const Side& side) noexcept { own_ = side, at_ = &own_; }
    void refer_to(const Side& side) noexcept { at_ = &side; }
    bool owns() const noexcept { return at_ == &own_; }
    bool refers_to(const Side& side) const noexcept { return at_ == &side; }
    const Side& operator*() const noexcept { return *at_; }
    const Side* operator->() const noexcept { return at_; }

   private:
    Side own_;
    const Side* at_ = &own_;
  };
  struct NodePair {  // of the two trees of spheres, or of triangles
    std::uint32_t a, b;
  };
  class PairList {  // a vector that does not grow by itself
   public:
    bool room_for(std::size_t more) const noexcept { return capacity_ - size_ >= more; }
    bool reserve(std::size_t capacity) noexcept;
    void push(NodePair pair) noexcept { pairs_[size_++] = pair; }
    void clear() noexcept { size_ = 0; }
    std::size_t size() const noexcept { return size_; }
    NodePair operator[](std::size_t i) const noexcept { return pairs_[i]; }

   private:
    std::unique_ptr<NodePair[]> pairs_;
    std::size_t size_ = 0, capacity_ = 0;
  };
  struct Cursor {  // where the level under way continues: lanes; rows
    std::size_t pair = 0;
    std::uint32_t outer = 0, inner = 0;
  };
  struct Best {
    double bound = std::numeric_limits<double>::infinity();
    NodePair pair{0, 0};
  };
  class BudgetTracker;

  bool bound_to(const PreparedTree& a, const PreparedTree& b) const noexcept;
  bool bound_where(const PreparedTree& a, const PreparedTree& b) const noexcept;
  // As bind(), without copies: the prepared trees outlive what is asked until the next bind.
  bool bind_where(const PreparedTree& a, const PreparedTree& b) noexcept;
  void order(const PreparedTree& a, const PreparedTree& b) noexcept;
  bool begin_anew() noexcept;
  void reset_counts() noexcept;
  void find_exact_error(const Pose& first, const Pose& second) noexcept;
  void keep(const Pose& a, const Pose& b) noexcept;
  void order_copies(const Pose& a, const Pose& b) noexcept;
  Answer refuse(const Pose& a, const Pose& b) noexcept;
  struct Probe;
  bool probe_below(NodePair pair, std::uint32_t levels, Probe& probe) noexcept;
  double hulls_gap(const Pose& first, const Pose& second, const std::array<double, 3>& way,
                   std::array<double, 3>& u) const noexcept;
  Pose relative_pose() const noexcept;
  void place() noexcept;
  bool has_triangles() const noexcept { return !first_->tree.ball_slabs.empty() && !second_->tree.ball_slabs.empty(); }
  bool has_last_level() const noexcept { return has_triangles() && stack_; }  // memory for its stack, too
  bool in_range() const noexcept;
  void finish(Answer answer) noexcept;

  Answer refine_level(const Budget& budget) noexcept;
  Answer refine_last(const Budget& budget) noexcept;
  bool refine_spheres(BudgetTracker& tracker) noexcept;
  void give_up_spheres() noexcept;
  void start_exact() noexcept;
  bool refine_ball_slabs(BudgetTracker& tracker) noexcept;
  void start_near(const NodePair& leaves) noexcept;
  bool refine_near(std::uint32_t a, std::uint32_t b, const Budget& budget) noexcept;
  bool find_children(const NodePair& pair, std::uint32_t a, std::uint32_t b, detail::BoxGaps& gaps) noexcept;
  void leave_out_apart(const NodePair& pair, bool second, std::uint32_t block, detail::BoxGaps& gaps) const noexcept;
  void push_children(const NodePair& pair, bool second, std::uint32_t block, const detail::BoxGaps& gaps) noexcept;
  detail::NodeBox moved_box(std::uint32_t node) const noexcept;  // of the second tree, in the first one's frame
  bool test_triangles(const NodePair& pair) noexcept;
  bool test_two(std::uint32_t a, std::uint32_t lane, std::uint32_t b, std::uint32_t row) noexcept;
  void add_ball(Contact& contact, std::array<double, 3>& normal) const noexcept;
  std::array<double, 3> triangle_normal() const noexcept;
  static NodePair pair_at(std::uint32_t row, std::uint32_t lane, std::uint32_t bit, bool lanes_are_second) noexcept {
    const NodePair pair{row + bit / kBlockWidth, lane + bit % kBlockWidth};
    return lanes_are_second ? pair : NodePair{pair.b, pair.a};
  }
  void collect(std::uint32_t row, std::uint32_t lane, const detail::BlockHits& hits, bool lanes_are_second) noexcept;
  void improve(NodePair pair, double square, bool leaves) noexcept;
  void start_level() noexcept;
  void finish_sphere_level() noexcept;

  // The pair in a fixed order that does not depend on the order of the arguments: exchanged_ tells.
  BoundSide first_, second_;
  std::array<std::uint64_t, 2> prints_{};         // their fingerprints, when they were bound where they are
  std::array<std::array<double, 2>, 3> roots_{};  // of both, coordinate by coordinate
  bool ordered_by_pose_ = false;                  // equal trees
  bool one_tree_ = false;                         // in the same place, too
  bool arguments_exchanged_ = false;
  bool exchanged_ = false;

  // Second's frame to first's, both relative to the trees' origins; in float for spheres, in double for triangles.
  // Everything below the roots happens in the first tree's own units.
  Pose first_pose_, second_pose_, relative_;
  double exact_error_ = 0;  // of a point's place in double, in the world
  bool placed_ = false;     // relative_ and placement_ are those of the poses
  detail::Placement placement_{};

  PairList inner_, leaves_, next_;  // meeting pairs: with an inner node, of two leaves, and of the level under way
  std::size_t settled_leaves_ = 0;
  Cursor cursor_;
  std::unique_ptr<NodePair[]> stack_;  // the last level's, deepest first; room for the trees' depths
  std::size_t stack_size_ = 0, stack_room_ = 0;
  bool exact_started_ = false;
  detail::LevelState level_state_{};
  Best level_best_, leaf_best_, best_;
  std::uint32_t triangle_first_ = kNoTriangle, triangle_second_ = kNoTriangle;
  struct Place {  // of two triangles that meet: ball slabs of leaves, and which triangles of these
    std::uint32_t first, second;
    std::uint8_t lane_first, lane_second;
  };
  Place meeting_{};
  std::array<double, 3> witness_{};

  Answer answer_ = Answer::no;
  bool finished_ = true;
  bool roots_pending_ = false;
  bool out_of_room_ = false;
  bool refused_ = false;
  std::uint32_t level_ = 0;
  std::uint64_t pair_tests_ = 0, triangle_tests_ = 0, work_ = 0;
  double separation_bound_ = std::numeric_limits<double>::infinity();
  double lower_bound_ = 0;
  double pruned_gap_ = std::numeric_limits<double>::infinity();
  std::array<double, 3> apart_along_{};  // from the first one to the second one, where the roots decided; in the world
};

}  // namespace orchard::runtime
