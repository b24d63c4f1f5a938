#include <algorithm>
#include <cmath>

#include "coherent_pair.h"
#include "front_walk.h"
#include "pair_access.h"
#include "pose_change.h"
#include "rigid_pair.h"
#include "tree/tree_nodes.h"
#include "triangle_pair.h"
#include "vector_functions.h"

namespace orchard::runtime {

using detail::dot;
using detail::minus;
using detail::Vec3;

namespace {

// A search that leaves a clearance goes on below what is closer than that, so it costs more the more is asked for, and
// many times as much where most of both bodies is so close. After each time that it was asked for in vain, it is half
// as often.
constexpr double kMinAhead = 2;        // steps that a clearance is asked for,
constexpr std::uint8_t kMaxAhead = 6;  // and how many more at most, one more each time that it is had
constexpr double kAlmost = 1 - 1e-3;
constexpr std::uint8_t kMaxMisses = 6;  // 2^6 tests without asking
constexpr std::size_t kTriangles = 3;   // witnesses that are tried by themselves, before their leaves are
constexpr std::uint8_t kFrontsBeforeRoots = 4;
constexpr double kMargin = 1 - 1e-9;  // the rounding of a few operations

double size_of(const Vec3& v) noexcept { return std::sqrt(dot(v, v)); }

// How far a point of the tree's triangles is at most from where it was, both places relative to the other body.
double displacement(const PreparedTree& tree, const Pose& before, const Pose& now) noexcept {
  const BallSlabBlock& root = tree.tree.ball_slabs[0];
  Vec3 middle = {root.x[0], root.y[0], root.z[0]};
  for (std::size_t i = 0; i < 3; ++i) middle[i] += tree.tree.origin[i];
  return size_of(minus(transform(now, middle), transform(before, middle))) +
         detail::pose_change(before, now) * double{root.radius[0]};
}

// What poses may be off by, in the first body's units: as NarrowPhase's error.
double slack(const PreparedTree& a, const PreparedTree& b, const Pose& pose_a, const Pose& pose_b) noexcept {
  double places = 0;
  for (std::size_t i = 0; i < 3; ++i) places += std::fabs(pose_a.translation[i]) + std::fabs(pose_b.translation[i]);
  return 2 * (a.error + b.error * pose_b.scale / pose_a.scale) + 4e-14 * places / pose_a.scale;
}

}  // namespace

struct Coherence {
  Workspace& workspace;
  TreePair& pair;
  const Pose &a, &b;
  TreePair::Memory& memory = pair.memory_;

  Pose relative{};
  double moved = 0;     // since `memory` saw them
  bool placed = false;  // the workspace's NarrowPhase is bound and placed

  // False: nothing can be remembered of these.
  bool place() noexcept {
    const PreparedTree &first = pair.a(), &second = pair.b();
    if (first.tree.ball_slabs.empty() || second.tree.ball_slabs.empty() || !rigid()) {
      pair.forget();
      return false;
    }
    relative = compose(inverse(a), b);
    moved = memory.seen ? displacement(second, memory.relative, relative) + slack(first, second, a, b) : 0;
    return true;
  }

  bool knows_nothing() const noexcept { return memory.witness_count == 0 && pair.front_ == nullptr; }

  bool rigid() const noexcept {  // both, side by side
    double places = 0;
    for (std::size_t i = 0; i < 3; ++i) places += std::fabs(a.translation[i]) + std::fabs(b.translation[i]);
    return std::isfinite(places) && detail::PoseLanes(a, b).rotate();
  }

  std::optional<Verdict> recall() noexcept {
    if (memory.seen && moved < memory.clearance * kMargin) {
      ++memory.answers;
      return apart((memory.clearance * kMargin - moved) * a.scale);
    }
    if (memory.witness_count == 0 || !witnesses_meet()) return std::nullopt;
    keep_place();
    return workspace.narrow.verdict();
  }

  void keep_place() noexcept {
    memory.clearance = 0;
    memory.relative = relative;
    memory.answers = 0;
    memory.seen = true;
  }

  static Verdict apart(double lower) noexcept {
    Verdict verdict;
    verdict.answer = Answer::no;
    verdict.separation_bound = std::numeric_limits<double>::infinity();
    verdict.lower_bound = std::max(0.0, lower);
    return verdict;
  }

  Verdict search(const Budget& budget, bool fast) noexcept {
    if (memory.witness_count > 0) return search_after_yes(budget);
    if (pair.front_ != nullptr) return search_front(budget);
    const double step = memory.seen ? moved / (memory.answers + 1) : 0;
    keep_place();
    if (memory.wait > 0) {
      --memory.wait;
    } else if (step > 0 && !fast) {
      return search_wide(step, budget);
    }
    return remember(runtime::collide(workspace, pair, a, b, budget));
  }

  // Of bodies that pass each other fast, and did not touch: where they are is not worth remembering.
  Verdict search_once(const Budget& budget) noexcept {
    memory.seen = false;
    return remember(runtime::collide(workspace, pair, a, b, budget));
  }

  // For a clearance that lasts some steps.
  Verdict search_wide(double step, const Budget& budget) noexcept {
    NarrowPhase& narrow = workspace.narrow;
    narrow.bind(pair.a(), pair.b());
    narrow.start(a, b);
    std::uint64_t spent = 0;
    if (!narrow.finished() && PairAccess::has_last_level(narrow)) {
      // Half of what is limited: the answer itself comes first.
      const Budget half = unlimited(budget) ? Budget{} : Budget{budget.pair_tests / 2 + 1};
      PairAccess::search_wide(narrow, (kMinAhead + memory.ahead) * step * a.scale, half);
      spent = narrow.work();
    }
    Verdict verdict = narrow.verdict();
    if (!narrow.finished()) {
      const Budget rest = unlimited(budget) ? budget : Budget{budget.pair_tests - std::min(spent, budget.pair_tests)};
      verdict = runtime::collide(workspace, pair, a, b, rest);
      verdict.work += spent;
    }
    remember(verdict);
    const double lasts = memory.clearance / step;
    if (lasts > kMinAhead * kAlmost) {
      const bool more = lasts > (kMinAhead + memory.ahead) * kAlmost;
      if (!more) memory.ahead = static_cast<std::uint8_t>(lasts > kMinAhead ? lasts - kMinAhead : 0);
      if (more && memory.ahead < kMaxAhead) ++memory.ahead;
      memory.misses = 0;
    } else {
      memory.ahead = 0;
      if (memory.misses < kMaxMisses) ++memory.misses;
      memory.wait = static_cast<std::uint8_t>(1u << memory.misses);
    }
    return verdict;
  }

  static bool unlimited(const Budget& budget) noexcept { return budget.pair_tests == Budget{}.pair_tests; }

  // Near the triangles that met last; else everywhere, without a front, which would be of no use where they still meet.
  Verdict search_after_yes(const Budget& budget) noexcept {
    NarrowPhase& narrow = workspace.narrow;
    keep_place();
    if (!place_narrow()) return remember(runtime::collide(workspace, pair, a, b, budget));
    Budget rest = budget;
    if (!leaves_meet(rest.pair_tests)) {
      if (pair.front_ != nullptr) pair.front_->clear();
      PairAccess::search(narrow, rest);
    }
    memory.close = true;
    return remember(narrow.verdict());
  }

  bool place_narrow() noexcept {
    if (placed) return true;
    workspace.narrow.bind(pair.a(), pair.b());
    placed = PairAccess::has_last_level(workspace.narrow) && PairAccess::place_only(workspace.narrow, a, b);
    return placed;
  }

  // On from the front, if it holds. The roots come first where they have decided before, or nothing is known, and now
  // and then, since they may decide again.
  Verdict search_front(const Budget& budget) noexcept {
    NarrowPhase& narrow = workspace.narrow;
    keep_place();
    if (!place_narrow()) return remember(runtime::collide(workspace, pair, a, b, budget));
    FrontWalk walk(*pair.front_, narrow);
    const bool tried = memory.close && memory.wait > 0;
    if (!tried || !walk.resume()) {
      narrow.start(a, b);
      memory.close = !narrow.finished();
      if (!memory.close) return remember(narrow.verdict());
      PairAccess::place_now(narrow);
      if (tried || !walk.resume()) walk.begin();
      memory.wait = kFrontsBeforeRoots;
    }
    --memory.wait;
    walk.run(budget);
    return remember(narrow.verdict());
  }

  // Whether triangles that met in the last answers still do, by the very test of the last level.
  bool witnesses_meet() noexcept {
    if (!place_narrow()) return false;
    const std::size_t count = std::min<std::size_t>(memory.witness_count, kTriangles);
    for (std::size_t i = 0; i < count; ++i) {
      const TreePair::Witness witness = memory.witnesses[i];
      if (!PairAccess::test_two(workspace.narrow, place_of(witness))) continue;
      std::copy_backward(memory.witnesses.begin(), memory.witnesses.begin() + static_cast<std::ptrdiff_t>(i),
                         memory.witnesses.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      memory.witnesses[0] = witness;
      return true;
    }
    return false;
  }

  PairAccess::Place place_of(const TreePair::Witness& w) const noexcept {
    if (PairAccess::exchanged(workspace.narrow)) return {w.b, w.a, w.lane_b, w.lane_a};
    return {w.a, w.b, w.lane_a, w.lane_b};
  }

  // The same of the leaves that they are in, which takes from the tests that are left. Precondition: placed.
  bool leaves_meet(std::uint64_t& left) noexcept {
    for (std::size_t i = 0; i < memory.witness_count; ++i) {
      const TreePair::Witness& w = memory.witnesses[i];
      const auto before = memory.witnesses.begin() + static_cast<std::ptrdiff_t>(i);
      if (std::any_of(memory.witnesses.begin(), before,
                      [&w](const TreePair::Witness& v) { return v.a == w.a && v.b == w.b; })) {
        continue;
      }
      if (left == 0) return false;
      constexpr std::uint64_t tests = std::uint64_t{kLeafPairTests} * kTriangleTestCost;
      PairAccess::add_work(workspace.narrow, tests);
      left -= std::min(left, tests);
      const PairAccess::Place place = place_of(w);
      if (PairAccess::test_leaves(workspace.narrow, place.first, place.second)) return true;
    }
    return false;
  }

  Verdict remember(const Verdict& verdict) noexcept {
    if (verdict.answer == Answer::yes) {
      memory.witness_count =
          static_cast<std::uint8_t>(std::min<std::size_t>(memory.witness_count + 1u, TreePair::kWitnesses));
      std::copy_backward(memory.witnesses.begin(), memory.witnesses.begin() + memory.witness_count - 1,
                         memory.witnesses.begin() + memory.witness_count);
      const PairAccess::Place& place = PairAccess::meeting(workspace.narrow);
      memory.witnesses[0] = {place.first, place.second, place.lane_first, place.lane_second};
      if (PairAccess::exchanged(workspace.narrow)) {
        memory.witnesses[0] = {place.second, place.first, place.lane_second, place.lane_first};
      }
    } else {
      memory.witness_count = 0;
    }
    memory.clearance = verdict.answer == Answer::no ? verdict.lower_bound / a.scale : 0;
    return verdict;
  }
};

std::optional<Verdict> CoherentPair::recall(Workspace& workspace, TreePair& pair, const Pose& a,
                                            const Pose& b) noexcept {
  Coherence coherence{workspace, pair, a, b};
  return coherence.place() ? coherence.recall() : std::nullopt;
}

Verdict CoherentPair::search(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b, const Budget& budget,
                             bool fast) noexcept {
  Coherence coherence{workspace, pair, a, b};
  if (fast && coherence.knows_nothing()) return coherence.search_once(budget);
  return coherence.place() ? coherence.search(budget, fast) : collide(workspace, pair, a, b, budget);
}

Verdict collide_coherently(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept {
  Coherence coherence{workspace, pair, a, b};
  if (!coherence.place()) return collide(workspace, pair, a, b);
  const std::optional<Verdict> known = coherence.recall();
  return known ? *known : coherence.search({}, false);
}

}  // namespace orchard::runtime
