#include "collision/pair_query.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

namespace orchard::runtime {

namespace {

constexpr double kMinOpposition = 1e-6;  // shorter differences of unit normals give no direction

}  // namespace

PairQuery::PairQuery(std::size_t room) noexcept {
  if (room > 0) reserve(room);
}

// Forgets what was known about the previous pair. Returns false if there is no memory for the stack.
bool PairQuery::bind(const PreparedTree& a, const PreparedTree& b) noexcept {
  trees_.bind(a, b);
  known_ = {};
  roots_pending_ = exact_started_ = false;
  spheres_.clear();
  return triangles_.reserve(trees_);
}

void PairQuery::reset() noexcept {
  spheres_.clear();
  spheres_.reset_tests();
  triangles_.reset_tests();
  known_.refused = false;
  known_.lower_bound = 0;
  known_.work = 0;
  known_.apart_along = {};
  level_ = 0;
  out_of_room_ = exact_started_ = false;
}

// Resets what only levels below the roots use.
void PairQuery::forget() noexcept {
  spheres_.forget(known_.separation_bound);
  triangles_.forget_found();
}

Answer PairQuery::start(const Pose& a, const Pose& b) noexcept {
  reset();
  roots_pending_ = false;
  known_.finished = true;
  Roots roots;
  const Roots::Answer answer = trees_.test_roots(a, b, roots);
  known_.separation_bound = roots.separation_bound;
  if (answer == Roots::Answer::apart) {
    known_.lower_bound = roots.lower_bound;
    known_.apart_along = roots.apart_along;
    return known_.answer = Answer::no;
  }
  forget();
  known_.refused = answer == Roots::Answer::refused;
  roots_pending_ = !known_.refused;
  known_.finished = known_.refused || (SphereLevels::roots_are_leaves(trees_) && !has_last_level());
  return known_.answer = Answer::maybe;
}

Answer PairQuery::refine_level(PairBudget& tracker) noexcept {
  if (roots_pending_) {
    trees_.place();
    roots_pending_ = false;
    if (!spheres_.begin(trees_)) return give_up_spheres(), known_.answer;
  }
  if (!spheres_.have_inner()) return refine_last(tracker);
  const std::uint64_t before = tracker.spent();
  const SphereLevels::End end = spheres_.refine(trees_, tracker);
  known_.separation_bound = std::min(known_.separation_bound, spheres_.least_bound() * trees_.first_pose().scale);
  if (end == SphereLevels::End::room) give_up_spheres();
  if (end == SphereLevels::End::level) {
    ++level_;
    if (spheres_.pairs() == 0) {
      finish(Answer::no);
    } else if (!spheres_.have_inner() && !has_last_level()) {
      finish(Answer::maybe);
    }
  }
  known_.work += tracker.spent() - before;
  return known_.answer;
}

Answer PairQuery::refine_last(PairBudget& tracker) noexcept {
  if (!has_last_level()) return refine_level(tracker);
  const std::uint64_t before = tracker.spent();
  if (!exact_started_) start_exact();
  if (triangles_.refine(trees_.views(), tracker)) {
    ++level_;
    finish(triangles_.any() ? Answer::yes : Answer::no);
  }
  known_.work += tracker.spent() - before;
  return known_.answer;
}

void PairQuery::start_exact() noexcept {
  exact_started_ = true;
  trees_.place();
  spheres_.clear();
  roots_pending_ = false;
  triangles_.start();
}

void PairQuery::give_up_spheres() noexcept {
  out_of_room_ = true;
  spheres_.give_up();
  if (!has_last_level()) finish(Answer::maybe);
}

void PairQuery::finish(Answer answer) noexcept {
  known_.answer = answer;
  known_.finished = true;
  roots_pending_ = false;
  const double scale = trees_.first_pose().scale;
  if (answer == Answer::no && !exact_started_) {
    known_.lower_bound = spheres_.pruned_gap() * scale * (1 - detail::kStretch);
  }
  if (answer == Answer::yes) {
    const double error = trees_.first().tree.vertex_error + trees_.second().tree.vertex_error * trees_.relative().scale;
    known_.separation_bound = std::min(known_.separation_bound, error * scale * (1 + detail::kStretch));
  }
}

NarrowPhase::Progress PairQuery::progress() const noexcept {
  return {level_,
          exact_started_,
          out_of_room_,
          roots_pending_ ? 1 : spheres_.pairs(),
          1 + spheres_.tests() + triangles_.tests().pairs,
          triangles_.tests().triangles,
          known_.work};
}

Contact PairQuery::contact() const noexcept {
  if (known_.answer == Answer::no || known_.refused) return {};
  Contact contact;
  Vec3 normal{};
  const MeetingTriangles& found = triangles_.found();
  const bool exchanged = trees_.exchanged();
  if (known_.answer == Answer::yes) {
    contact.center = found.common;
    normal = triangle_normal();
    contact.triangle_a = exchanged ? found.second : found.first;
    contact.triangle_b = exchanged ? found.first : found.second;
  }
  // If the triangles of a "yes" give no direction, that of the spheres is used.
  if (known_.answer != Answer::yes || !(length(normal) > 0)) add_ball(contact, normal);
  contact.center = trees_.in_world(contact.center);
  if (exchanged) normal = Vec3() - normal;
  contact.radius *= trees_.first_pose().scale;
  contact.normal = rotate(trees_.first_pose(), normal);
  return contact;
}

// Sets `normal` to the direction from the first sphere of the best pair to the second one. Unless triangles meet, the
// contact becomes the smallest ball around the common part of these spheres.
void PairQuery::add_ball(Contact& contact, Vec3& normal) const noexcept {
  const TreeView &first = trees_.first().tree, &second = trees_.second().tree;
  const auto [a, b] = spheres_.best().pair;
  const auto p = detail::center_of(first, a);
  const Pose relative = trees_.relative_pose();
  const auto q = transform(relative, detail::center_of(second, b));
  const Vec3 way = detail::minus(q, p);
  const double distance = length(way);
  normal = {1, 0, 0};
  for (std::size_t i = 0; i < 3 && distance > 0; ++i) normal[i] = way[i] / distance;
  if (known_.answer == Answer::yes) return;
  const double ra = detail::block_of(first, a).radius[a % kBlockWidth];
  const double rb = detail::block_of(second, b).radius[b % kBlockWidth] * relative.scale;
  // The smallest ball around the common part of two balls is one of them if less than half of it is cut off. Otherwise,
  // it is the ball on the circle in which the spheres cut each other, `at` away from p.
  const double at = distance > 0 ? (distance * distance + ra * ra - rb * rb) / (2 * distance) : 0;
  double share = 0;  // of the way from p to q
  if (distance == 0 || at <= 0 || at >= distance) {
    contact.radius = std::min(ra, rb);
    share = ra <= rb ? 0 : 1;
  } else {
    contact.radius = std::sqrt(std::max(0.0, ra * ra - at * at));
    share = at / distance;
  }
  contact.center = detail::along(p, way, share);
}

// Returns the direction from the first solid to the second one: the first triangle's outward normal less the second
// one's. Returns 0 if it is unknown.
Vec3 PairQuery::triangle_normal() const noexcept {
  const auto unit = [](Vec3 v, double least) {  // 0 if it is no longer than `least`
    const double size = length(v);
    for (double& component : v) component = size > least ? component / size : 0;
    return v;
  };
  const auto normal_of = [unit](const detail::TrianglePoints& t) {
    return unit(detail::cross(detail::minus(t[1], t[0]), detail::minus(t[2], t[0])), 0);
  };
  const auto of_first = normal_of(detail::points_of(trees_.first().tree, triangles_.found().first));
  const auto of_second =
      rotate(trees_.relative(), normal_of(detail::points_of(trees_.second().tree, triangles_.found().second)));
  return unit(detail::minus(of_first, of_second), kMinOpposition);
}

Verdict PairQuery::verdict() const noexcept {
  return {known_.answer, known_.separation_bound, known_.lower_bound, contact(), level_, known_.work};
}

bool DirectSearch::place(const Pose& a, const Pose& b) noexcept {
  query_.reset();
  query_.known_.separation_bound = std::numeric_limits<double>::infinity();
  const bool placed = query_.trees_.place_for_triangles(a, b);
  query_.forget();
  query_.known_.answer = Answer::maybe;
  query_.known_.finished = query_.known_.refused = !placed;
  return placed;
}

bool DirectSearch::say_yes_if(bool meet) noexcept {
  if (!meet) return false;
  query_.exact_started_ = true;
  query_.finish(Answer::yes);
  return true;
}

}  // namespace orchard::runtime
