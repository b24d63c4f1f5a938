#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <memory>

#include "collision/kernels/placement.h"
#include "collision/pair_budget.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime {

namespace detail {
struct BlockHits;
struct BoxGaps;
struct NodeBox;
}  // namespace detail

// A NarrowPhase as the other queries of a pair see it: its public members are NarrowPhase's, and say the same.
class PairQuery {
 public:
  static constexpr std::size_t kDefaultRoom = NarrowPhase::kDefaultRoom;
  PairQuery(const TreeView& a, const TreeView& b, std::size_t room = kDefaultRoom) noexcept;
  explicit PairQuery(std::size_t room = kDefaultRoom) noexcept;
  bool bind(const PreparedTree& a, const PreparedTree& b) noexcept;
  bool reserve(std::size_t pairs) noexcept;

  Answer start(const Pose& a, const Pose& b) noexcept;
  Answer refine() noexcept { return refine(Budget{}); }
  Answer refine(const Budget& budget) noexcept { return finished_ ? answer_ : refine_level(budget); }
  Answer refine_exactly(const Budget& budget = {}) noexcept { return finished_ ? answer_ : refine_last(budget); }
  Answer probe(std::uint32_t level) noexcept;

  Verdict verdict() const noexcept;
  Answer answer() const noexcept { return answer_; }
  bool finished() const noexcept { return finished_; }
  bool refused() const noexcept { return refused_; }
  bool out_of_room() const noexcept { return out_of_room_; }
  bool exact() const noexcept { return exact_started_; }
  std::uint32_t level() const noexcept { return level_; }
  std::size_t pairs() const noexcept { return roots_pending_ ? 1 : inner_.size() + settled_leaves_; }
  std::uint64_t pair_tests() const noexcept { return pair_tests_; }
  std::uint64_t triangle_tests() const noexcept { return triangle_tests_; }
  std::uint64_t work() const noexcept { return work_; }
  double separation_bound() const noexcept { return separation_bound_; }
  double lower_bound() const noexcept { return lower_bound_; }
  Contact contact() const noexcept;

  // What the other queries about a pair use: the bodies' order, their placement in each other's frame, and what covers
  // its rounding.
  struct NodePair {  // of the two trees of spheres, or of triangles
    std::uint32_t a, b;
  };
  struct Place {  // of two triangles that meet: ball slabs of leaves, and which triangles of these
    std::uint32_t first, second;
    std::uint8_t lane_first, lane_second;
  };
  // As bind(), without copies: the prepared trees outlive what is asked until the next bind.
  bool bind_where(const PreparedTree& a, const PreparedTree& b) noexcept;
  // Prepares for queries in the first tree's frame, whatever the roots say. False where nothing can be said.
  bool place(const Pose& a, const Pose& b) noexcept;
  // The same without a look at the roots, and only as far as test_two() needs it: place() does the rest. Precondition:
  // both poses are rigid.
  bool place_for_triangles(const Pose& a, const Pose& b) noexcept;
  // After that, or after start() that has left the bodies to deeper levels.
  void place() noexcept;
  // Precondition of what follows: place() gave true.
  const PreparedTree& first() const noexcept { return *first_; }
  const PreparedTree& second() const noexcept { return *second_; }
  const Pose& first_pose() const noexcept { return first_pose_; }
  const Pose& second_pose() const noexcept { return second_pose_; }
  const Pose& relative() const noexcept { return relative_; }
  const detail::Placement& placement() const noexcept { return placement_; }
  bool exchanged() const noexcept { return exchanged_; }
  double exact_error() const noexcept { return exact_error_; }  // in the world
  // Whether these triangles of the first and of the second tree meet, by the test of the last level: then that is said.
  bool test_two(const Place& p) noexcept {
    return say_yes_if(triangles_meet(p.first, p.lane_first, p.second, p.lane_second));
  }
  // The same of all triangles of two leaves.
  bool test_leaves(std::uint32_t first, std::uint32_t second) noexcept {
    return say_yes_if(test_triangles({first, second}));
  }
  // The same of what is beside these leaves in the trees, but for the leaves themselves, as far as the budget goes.
  bool search_near(std::uint32_t first, std::uint32_t second, const Budget& budget) noexcept;
  const Place& meeting() const noexcept { return meeting_; }  // after "yes"
  // All of the last level.
  void search(const Budget& budget) noexcept { refine_last(budget); }
  // That none do, and how far apart they are at least, in the world.
  void say_no(double lower) noexcept;
  // After a "no" of the roots: the direction from a to b along which the bodies are lower_bound() apart, of length 1
  // but for rounding. Else 0.
  Vec3 apart_along() const noexcept {
    const auto& u = apart_along_;
    return arguments_exchanged_ ? Vec3{-u[0], -u[1], -u[2]} : u;
  }
  void add_work(std::uint64_t work) noexcept { work_ += work; }
  bool has_triangles() const noexcept { return !first_->tree.obb_nodes.empty() && !second_->tree.obb_nodes.empty(); }
  bool has_last_level() const noexcept { return has_triangles() && stack_; }  // memory for its stack, too
  NodePair* stack() const noexcept { return stack_.get(); }

 private:
  friend class DistanceSearch;
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
  bool bound_to(const PreparedTree& a, const PreparedTree& b) const noexcept;
  bool bound_where(const PreparedTree& a, const PreparedTree& b) const noexcept;
  void order(const PreparedTree& a, const PreparedTree& b) noexcept;
  bool start_over() noexcept;
  void reset_counts() noexcept;
  void find_exact_error(const Pose& first, const Pose& second) noexcept;
  void keep(const Pose& a, const Pose& b) noexcept;
  void order_copies(const Pose& a, const Pose& b) noexcept;
  Answer refuse(const Pose& a, const Pose& b) noexcept;
  struct Probe;
  bool probe_below(NodePair pair, std::uint32_t levels, Probe& probe) noexcept;
  double hulls_gap(const Pose& first, const Pose& second, const Vec3& way, Vec3& u) const noexcept;
  Pose relative_pose() const noexcept;
  bool in_range() const noexcept;
  void finish(Answer answer) noexcept;

  Answer refine_level(const Budget& budget) noexcept;
  Answer refine_last(const Budget& budget) noexcept;
  bool refine_spheres(PairBudget& tracker) noexcept;
  void give_up_spheres() noexcept;
  void start_exact() noexcept;
  bool refine_obb_nodes(PairBudget& tracker) noexcept;
  void start_near(const NodePair& leaves) noexcept;
  bool find_children(const NodePair& pair, std::uint32_t a, std::uint32_t b, detail::BoxGaps& gaps) noexcept;
  void leave_out_apart(const NodePair& pair, bool second, std::uint32_t block, detail::BoxGaps& gaps) const noexcept;
  void push_children(const NodePair& pair, bool second, std::uint32_t block, const detail::BoxGaps& gaps) noexcept;
  detail::NodeBox moved_box(std::uint32_t node) const noexcept;  // of the second tree, in the first one's frame
  bool test_triangles(const NodePair& pair) noexcept;
  bool triangles_meet(std::uint32_t a, std::uint32_t lane, std::uint32_t b, std::uint32_t row) noexcept;
  bool say_yes_if(bool meet) noexcept;
  void add_ball(Contact& contact, Vec3& normal) const noexcept;
  Vec3 triangle_normal() const noexcept;
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
  Place meeting_{};
  Vec3 witness_{};

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
  Vec3 apart_along_{};  // from the first one to the second one, where the roots decided; in the world
};

// The query that a NarrowPhase, or a workspace's, is a cover of.
PairQuery& query_of(NarrowPhase& pair) noexcept;

// collide() for it, and the same with Order::exact_first, but for the verdict.
Verdict collide(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget = {},
                Order order = Order::exact_first) noexcept;
void answer_exactly(PairQuery& pair, const Pose& a, const Pose& b, const Budget& budget) noexcept;

}  // namespace orchard::runtime
