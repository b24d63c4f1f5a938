#include <algorithm>
#include <cmath>
#include <new>
#include <optional>

#include "collision/coherent_pair.h"
#include "collision/pair_query.h"
#include "collision/pose_change.h"
#include "math/rigid_pair.h"
#include "math/triangle_pair.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

namespace orchard::runtime {

using detail::minus;

namespace {

constexpr std::uint8_t kSearchesBeforeRoots = 4;
constexpr std::uint8_t kInVain = 4;   // answers of roots that told nothing, before they are asked now and then only
constexpr double kMargin = 1 - 1e-9;  // the rounding of a few operations

// How far a point of the tree's triangles is at most from where it was, both places relative to the other body.
double displacement(const PreparedTree& tree, const Pose& before, const Pose& now) noexcept {
  const ObbNodeBlock& root = tree.tree.obb_nodes[0];
  Vec3 middle = {root.x[0], root.y[0], root.z[0]};
  for (std::size_t i = 0; i < 3; ++i) middle[i] += tree.tree.origin[i];
  return length(minus(transform(now, middle), transform(before, middle))) +
         detail::pose_change(before, now) * double{root.radius[0]};
}

// What poses may be off by, in the first body's units: as NarrowPhase's error.
double slack(const PreparedTree& a, const PreparedTree& b, const Pose& pose_a, const Pose& pose_b) noexcept {
  double places = 0;
  for (std::size_t i = 0; i < 3; ++i) places += std::fabs(pose_a.translation[i]) + std::fabs(pose_b.translation[i]);
  return 2 * (a.error + b.error * pose_b.scale / pose_a.scale) + 4e-14 * places / pose_a.scale;
}

}  // namespace

class Coherence {
 public:
  Coherence(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept
      : narrow_(query_of(workspace.narrow)), pair_(pair), a_(a), b_(b) {}

  static bool remembers(const TreePair& of) noexcept { return of.memory_.clearance > 0 || of.memory_.met; }

  // Verdicts are made where they stay: copied at once, they would not have left the processor's store queue yet.
  bool recall(Verdict& verdict) noexcept {
    if (!remembers(pair_)) return false;
    if (!find_rigid()) {
      pair_.forget();
      return false;
    }
    if (memory_.clearance > 0) {
      const double moved =
          displacement(pair_.b(), memory_.relative, find_relative()) + slack(pair_.a(), pair_.b(), a_, b_);
      const double left = memory_.clearance * kMargin - moved;
      if (left > 0) {
        verdict = apart(left * a_.scale);
        return true;
      }
    }
    if (!memory_.met || !place_for_triangles() || !direct_.test_two(last_place())) return false;
    ::new (&verdict) Verdict(narrow_.verdict());
    return true;
  }

  // First in the leaves of the triangles that met last.
  Verdict search(const Budget& budget) noexcept {
    if (!memory_.met || !place_for_triangles()) {
      narrow_.bind(pair_.a(), pair_.b());
      answer_exactly(narrow_, a_, b_, budget);
      return remembered();
    }
    narrow_.trees().place();
    constexpr std::uint64_t tests = std::uint64_t{kLeafPairTests} * kTriangleTestCost;
    const MeetingTriangles::Place place = last_place();
    if (budget.work == 0) return remembered();
    direct_.add_work(tests);
    Budget rest = budget;
    rest.work -= std::min(rest.work, tests);
    if (!direct_.test_leaves({place.first, place.second})) direct_.search(rest);
    return remembered();
  }

  // The query's verdict.
  Verdict remembered() noexcept {
    const Answer answer = narrow_.known().answer;
    memory_.met = answer == Answer::yes;
    if (memory_.met) {
      const MeetingTriangles::Place& place = direct_.found().place;
      memory_.witness = narrow_.trees().exchanged()
                            ? TreePair::Witness{place.second, place.first, place.lane_second, place.lane_first}
                            : TreePair::Witness{place.first, place.second, place.lane_first, place.lane_second};
    }
    const bool have_triangles = !pair_.a().tree.obb_nodes.empty() && !pair_.b().tree.obb_nodes.empty();
    memory_.clearance = answer == Answer::no && have_triangles ? narrow_.known().lower_bound / a_.scale : 0;
    if (memory_.clearance > 0) memory_.relative = find_relative();
    return narrow_.verdict();
  }

 private:
  bool find_rigid() noexcept {  // both, side by side
    if (rigid_) return true;
    double places = 0;
    for (std::size_t i = 0; i < 3; ++i) places += std::fabs(a_.translation[i]) + std::fabs(b_.translation[i]);
    return rigid_ = std::isfinite(places) && detail::PoseLanes(a_, b_).rotate();
  }

  const Pose& find_relative() noexcept {
    if (!relative_) relative_.emplace(compose(inverse(a_), b_));
    return *relative_;
  }

  static Verdict apart(double lower) noexcept {
    Verdict verdict;
    verdict.answer = Answer::no;
    verdict.separation_bound = std::numeric_limits<double>::infinity();
    verdict.lower_bound = std::max(0.0, lower);
    return verdict;
  }

  bool place_for_triangles() noexcept {
    if (placed_) return true;
    narrow_.bind(pair_.a(), pair_.b());
    placed_ = narrow_.has_last_level() && find_rigid() && direct_.place(a_, b_);
    return placed_;
  }

  MeetingTriangles::Place last_place() const noexcept {
    const TreePair::Witness& w = memory_.witness;
    if (narrow_.trees().exchanged()) return {w.b, w.a, w.lane_b, w.lane_a};
    return {w.a, w.b, w.lane_a, w.lane_b};
  }

  PairQuery& narrow_;  // the workspace's
  DirectSearch direct_{narrow_};
  TreePair& pair_;
  const Pose &a_, &b_;
  TreePair::Memory& memory_ = pair_.memory_;

  bool placed_ = false;                // the workspace's NarrowPhase is bound and placed for triangles
  bool rigid_ = false;                 // both poses are, once that has been looked at
  std::optional<Pose> relative_ = {};  // of b in a's frame, likewise
};

bool CoherentPair::recall(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b,
                          Verdict& verdict) noexcept {
  return Coherence(workspace, pair, a, b).recall(verdict);
}

bool CoherentPair::remembers(const TreePair& pair) noexcept { return Coherence::remembers(pair); }

Verdict CoherentPair::search(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b,
                             const Budget& budget) noexcept {
  return Coherence(workspace, pair, a, b).search(budget);
}

void CoherentPair::remember(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept {
  Coherence(workspace, pair, a, b).remembered();
}

Verdict collide_coherently(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept {
  Coherence coherence(workspace, pair, a, b);
  Verdict known;
  return coherence.recall(known) ? known : coherence.search({});
}

}  // namespace orchard::runtime
