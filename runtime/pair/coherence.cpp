#include <algorithm>
#include <cmath>

#include "coherent_pair.h"
#include "pair_access.h"
#include "tree/tree_nodes.h"
#include "triangle_pair.h"
#include "vector_functions.h"

namespace orchard::runtime {

using detail::dot;
using detail::minus;
using detail::Vec3;

namespace {

// A clearance costs some three tests: it is asked for where it lasts for more steps than that, and after each time that
// it was asked for in vain, half as often.
constexpr double kAhead = 8;            // steps that a clearance is asked for
constexpr std::uint8_t kMaxMisses = 6;  // 2^6 tests without asking
constexpr double kMargin = 1 - 1e-9;    // the rounding of a few operations

double size_of(const Vec3& v) noexcept { return std::sqrt(dot(v, v)); }

// How far a point of the tree's triangles is at most from where it was, both places relative to the other body.
double displacement(const PreparedTree& tree, const Pose& before, const Pose& now) noexcept {
  const BallSlabBlock& root = tree.tree.ball_slabs[0];
  Vec3 middle = {root.x[0], root.y[0], root.z[0]};
  for (std::size_t i = 0; i < 3; ++i) middle[i] += tree.tree.origin[i];
  double square = 0;
  for (std::size_t i = 0; i < 9; ++i) {
    const double change = now.scale * now.rotation[i] - before.scale * before.rotation[i];
    square += change * change;
  }
  // Two rotations differ by an angle about an axis, so that a vector changes by at most 1 / sqrt(2) of that norm.
  const double turn = std::sqrt(now.scale == before.scale ? square / 2 : square);
  return size_of(minus(transform(now, middle), transform(before, middle))) + turn * double{root.radius[0]};
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
  double moved = 0;  // since `memory` saw them

  // False: nothing can be remembered of these.
  bool place() noexcept {
    const PreparedTree &first = pair.a(), &second = pair.b();
    if (first.tree.ball_slabs.empty() || second.tree.ball_slabs.empty() || !is_rigid(a) || !is_rigid(b)) {
      pair.forget();
      return false;
    }
    relative = compose(inverse(a), b);
    moved = memory.seen ? displacement(second, memory.relative, relative) + slack(first, second, a, b) : 0;
    return true;
  }

  std::optional<Verdict> recall() noexcept {
    if (!memory.seen) return std::nullopt;
    if (moved < memory.clearance * kMargin) {
      ++memory.answers;
      return apart((memory.clearance * kMargin - moved) * a.scale);
    }
    if (memory.triangle_a == kNoTriangle || !same_triangles_meet()) return std::nullopt;
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

  Verdict search(const Budget& budget) noexcept {
    const double step = memory.seen ? moved / (memory.answers + 1) : 0;
    keep_place();
    std::uint64_t spent = 0;
    if (memory.wait > 0) {
      --memory.wait;
    } else if (step > 0) {
      const double ahead = kAhead * step * a.scale;
      DistanceQuery& query = workspace.distance;
      query.bind(pair.a(), pair.b());
      query.start_within(a, b, ahead);
      // Half of what is limited: the answer itself comes first.
      query.refine(unlimited(budget) ? Budget{} : Budget{budget.pair_tests / 2 + 1});
      spent = query.work();
      if (query.finished() && query.lower() > ahead) {
        memory.clearance = query.lower() / a.scale;
        memory.triangle_a = memory.triangle_b = kNoTriangle;
        memory.misses = 0;
        Verdict verdict = apart(query.lower());
        verdict.work = spent;
        return verdict;
      }
      if (memory.misses < kMaxMisses) ++memory.misses;
      memory.wait = static_cast<std::uint8_t>(1u << memory.misses);
    }
    Budget rest = budget;
    if (!unlimited(budget)) rest.pair_tests -= std::min(spent, rest.pair_tests);
    Verdict verdict = remember(runtime::collide(workspace, pair, a, b, rest));
    verdict.work += spent;
    return verdict;
  }

  static bool unlimited(const Budget& budget) noexcept { return budget.pair_tests == Budget{}.pair_tests; }

  // Whether the triangles that met last still do, by the very test of the last level.
  bool same_triangles_meet() noexcept {
    NarrowPhase& narrow = workspace.narrow;
    narrow.bind(pair.a(), pair.b());
    if (!PairAccess::place_only(narrow, a, b)) return false;
    const bool exchanged = PairAccess::exchanged(narrow);
    const std::uint32_t first = exchanged ? memory.triangle_b : memory.triangle_a,
                        second = exchanged ? memory.triangle_a : memory.triangle_b;
    detail::TrianglePoints q = detail::points_of(PairAccess::second(narrow).tree, second);
    for (Vec3& point : q) point = transform(PairAccess::relative(narrow), point);
    Vec3 witness{};
    if (!detail::triangles_intersect(detail::points_of(PairAccess::first(narrow).tree, first), q, &witness)) {
      return false;
    }
    PairAccess::say_yes(narrow, first, second, witness);
    return true;
  }

  Verdict remember(const Verdict& verdict) noexcept {
    const bool yes = verdict.answer == Answer::yes;
    memory.triangle_a = yes ? verdict.contact.triangle_a : kNoTriangle;
    memory.triangle_b = yes ? verdict.contact.triangle_b : kNoTriangle;
    memory.clearance = verdict.answer == Answer::no ? verdict.lower_bound / a.scale : 0;
    return verdict;
  }
};

std::optional<Verdict> CoherentPair::recall(Workspace& workspace, TreePair& pair, const Pose& a,
                                            const Pose& b) noexcept {
  Coherence coherence{workspace, pair, a, b};
  return coherence.place() ? coherence.recall() : std::nullopt;
}

Verdict CoherentPair::search(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b,
                             const Budget& budget) noexcept {
  Coherence coherence{workspace, pair, a, b};
  return coherence.place() ? coherence.search(budget) : collide(workspace, pair, a, b, budget);
}

Verdict collide_coherently(Workspace& workspace, TreePair& pair, const Pose& a, const Pose& b) noexcept {
  Coherence coherence{workspace, pair, a, b};
  if (!coherence.place()) return collide(workspace, pair, a, b);
  const std::optional<Verdict> known = coherence.recall();
  return known ? *known : coherence.search({});
}

}  // namespace orchard::runtime
