#include <algorithm>
#include <cmath>
#include <new>

#include "collision/coherent_pair.h"
#include "collision/pose_change.h"
#include "math/rigid_pair.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

namespace orchard::runtime {

using detail::minus;

namespace {

constexpr double kMargin = 1 - 1e-9;  // covers the rounding of a few operations
// If the roots and hulls of a pair have not separated it at kStreak poses in turn, they seldom do so at the next ones:
// three of four further searches do not test them.
constexpr int kStreak = 8, kBelowRoots = kStreak + 3;

// Returns a bound on how far any point of the tree's triangles has moved from `before` to `now`. Both are poses in the
// frame of the other body.
double displacement(const PreparedTree& tree, const Pose& before, const Pose& now) noexcept {
  const detail::Ball all = detail::ball_around(tree.tree);
  const Vec3 middle = all.middle + tree.tree.origin;
  return length(minus(transform(now, middle), transform(before, middle))) +
         detail::pose_change(before, now) * all.radius;
}

// Returns a bound on the rounding errors of two placements of the pair together, in the first body's units; see
// PlacedTrees::exact_error().
double slack(const PreparedTree& a, const PreparedTree& b, const Pose& pose_a, const Pose& pose_b) noexcept {
  const double places = detail::one_norm(pose_a.translation) + detail::one_norm(pose_b.translation);
  return 2 * (a.error + b.error * pose_b.scale / pose_a.scale) + 4e-14 * places / pose_a.scale;
}

}  // namespace

// The verdict is constructed in place: a copy made at once would have to wait, because the verdict would still be in
// the processor's store queue.
bool CoherentPair::recall(Verdict& verdict) noexcept {
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
      verdict = {};
      verdict.answer = Answer::no;
      verdict.separation_bound = std::numeric_limits<double>::infinity();
      verdict.lower_bound = left * a_.scale;
      return true;
    }
  }
  if (!memory_.met || !place_for_triangles() || !direct_.test_two(last_place())) return false;
  ::new (&verdict) Verdict(narrow_.verdict());
  return true;
}

Verdict CoherentPair::search(const Budget& budget) noexcept {
  if ((!memory_.met && memory_.below_roots <= kStreak) || !place_for_triangles()) {
    narrow_.bind(pair_.a(), pair_.b());
    answer_exactly(narrow_, a_, b_, budget);
    const bool apart = dot(narrow_.known().apart_along, narrow_.known().apart_along) > 0;
    memory_.below_roots = apart ? 0 : memory_.below_roots < kStreak ? memory_.below_roots + 1 : kBelowRoots;
    return remember();
  }
  narrow_.trees().place();
  if (!memory_.met) {
    --memory_.below_roots;
    narrow_.refine_exactly(budget);
    return remember();
  }
  constexpr std::uint64_t tests = std::uint64_t{kLeafPairTests} * kTriangleTestCost;
  if (budget.work == 0) return remember();
  direct_.add_work(tests);
  Budget rest = budget;
  rest.work -= std::min(rest.work, tests);
  if (!direct_.test_leaves(last_place())) narrow_.refine_exactly(rest);
  return remember();
}

Verdict CoherentPair::remember() noexcept {
  const Answer answer = narrow_.known().answer;
  memory_.met = answer == Answer::yes;
  if (memory_.met) {
    const MeetingTriangles::Place& place = direct_.found().place;
    memory_.witness = in_order({place.a, place.b, place.lane_a, place.lane_b});
  }
  const bool have_triangles = !pair_.a().tree.obb_nodes.empty() && !pair_.b().tree.obb_nodes.empty();
  memory_.clearance = answer == Answer::no && have_triangles ? narrow_.known().lower_bound / a_.scale : 0;
  if (memory_.clearance > 0) memory_.relative = find_relative();
  return narrow_.verdict();
}

bool CoherentPair::find_rigid() noexcept {
  if (rigid_) return true;
  const double places = detail::one_norm(a_.translation) + detail::one_norm(b_.translation);
  return rigid_ = std::isfinite(places) && detail::PoseLanes(a_, b_).rotate();
}

const Pose& CoherentPair::find_relative() noexcept {
  if (!relative_) relative_.emplace(compose(inverse(a_), b_));
  return *relative_;
}

bool CoherentPair::place_for_triangles() noexcept {
  if (placed_) return true;
  narrow_.bind(pair_.a(), pair_.b());
  placed_ = narrow_.has_last_level() && find_rigid() && direct_.place(a_, b_);
  return placed_;
}

TreePair::Witness CoherentPair::in_order(const TreePair::Witness& w) const noexcept {
  return narrow_.trees().exchanged() ? TreePair::Witness{w.b, w.a, w.lane_b, w.lane_a} : w;
}

MeetingTriangles::Place CoherentPair::last_place() const noexcept {
  const TreePair::Witness w = in_order(memory_.witness);
  return {{w.a, w.b}, w.lane_a, w.lane_b};
}

Verdict collide_coherently(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept {
  CoherentPair coherent(workspace, pair, a, b);
  Verdict known;
  return coherent.recall(known) ? known : coherent.search();
}

}  // namespace orchard::runtime
