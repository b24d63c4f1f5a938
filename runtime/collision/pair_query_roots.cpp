#include <cmath>
#include <limits>
#include <utility>

#include "collision/pair_query.h"
#include "collision/support_map.h"
#include "math/rigid_pair.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

// Level 0: where most pairs end, so nothing is done here that only deeper levels need. In double and in the world:
// bodies that are far apart must not overflow. Exchanging the bodies changes no bit of any result, so that equal trees
// need no order yet.
namespace orchard::runtime {

using detail::minus;

namespace {

constexpr double kMinError = 1e-150;  // of a length: covers the underflow of its square
constexpr int kRootDirections = 5;    // tried at most, to part the hulls

bool before(const Pose& a, const Pose& b) noexcept {
  if (a.rotation != b.rotation) return a.rotation < b.rotation;
  return a.translation != b.translation ? a.translation < b.translation : a.scale < b.scale;
}

Vec3 turned_back(const Pose& pose, const Vec3& u) noexcept {
  const auto& r = pose.rotation;
  return {r[0] * u[0] + r[3] * u[1] + r[6] * u[2], r[1] * u[0] + r[4] * u[1] + r[7] * u[2],
          r[2] * u[0] + r[5] * u[1] + r[8] * u[2]};
}

double sum_of_sizes(const Vec3& v) noexcept { return std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]); }

}  // namespace

void PairQuery::reset_counts() noexcept {
  inner_.clear();
  settled_leaves_ = 0;
  level_ = 0;
  pair_tests_ = 1;
  triangle_tests_ = work_ = 0;
  lower_bound_ = 0;
  out_of_room_ = exact_started_ = refused_ = false;
  apart_along_ = {};
}

void PairQuery::find_exact_error(const Pose& first, const Pose& second) noexcept {
  exact_error_ = (first.scale * first_->error + second.scale * second_->error) +
                 1e-14 * (sum_of_sizes(first.translation) + sum_of_sizes(second.translation)) + kMinError;
}

Answer PairQuery::start(const Pose& a, const Pose& b) noexcept {
  reset_counts();
  // Nothing below holds otherwise, and the hulls' tables have no place for directions that are no directions.
  const Pose &first = arguments_exchanged_ ? b : a, &second = arguments_exchanged_ ? a : b;
  const detail::PoseLanes poses(first, second);
  if (!poses.rotate()) return refuse(a, b);
  const auto lanes = [](const std::array<double, 2>& pair) { return detail::Two{pair[0], pair[1]}; };
  const detail::Two roots[3] = {lanes(roots_[0]), lanes(roots_[1]), lanes(roots_[2])};
  Vec3 way{};
  for (std::size_t i = 0; i < 3; ++i) {
    const detail::Two place = poses.placed(i, roots);
    way[i] = place[1] - place[0];
  }
  const double square = dot(way, way), distance = std::sqrt(square);
  const auto sum = [&first, &second](double of_first, double of_second) {
    return first.scale * of_first + second.scale * of_second;
  };
  find_exact_error(first, second);
  const double radii = sum(first_->radius, second_->radius);
  separation_bound_ = detail::pair_bound(distance + exact_error_, radii, sum(first_->reach, second_->reach),
                                         sum(first_->depth, second_->depth));
  const double ball_gap = distance - radii - exact_error_;
  double gap = ball_gap;
  Vec3 along = way;
  if (gap <= 0 && square > 0 && has_triangles()) {
    // How far the bodies' convex hulls are apart, at least: along the line through the roots' centres first.
    const auto reach = [](const Side& side, const Pose& pose, const Vec3& u) {
      const Vec3 direction = turned_back(pose, u);
      return pose.scale * (detail::reach_along(side.tree.supports, direction) - dot(direction, side.middle));
    };
    gap = square - (reach(*first_, first, way) + reach(*second_, second, -way));
    if (!(gap > 0)) gap = hulls_gap(first, second, way, along);
    gap = gap / distance * (1 - detail::kStretch) - detail::kStretch * distance - exact_error_;
  }
  if (gap > 0 && std::isfinite(gap)) {
    answer_ = Answer::no;
    finished_ = true;
    roots_pending_ = false;
    lower_bound_ = gap * (1 - detail::kStretch);
    for (std::size_t i = 0; i < 3; ++i) apart_along_[i] = along[i] / distance;
    return answer_;
  }
  keep(a, b);
  if (!std::isfinite(ball_gap) || !in_range()) return refuse(a, b);
  answer_ = Answer::maybe;
  roots_pending_ = true;
  finished_ = detail::is_leaf(first_->tree, 0) && detail::is_leaf(second_->tree, 0) && !has_last_level();
  return answer_;
}

// Poses that name no place, or one beyond what floats can hold: nothing is certain then and nothing can be refined.
Answer PairQuery::refuse(const Pose& a, const Pose& b) noexcept {
  keep(a, b);
  refused_ = finished_ = true;
  roots_pending_ = false;
  separation_bound_ = std::numeric_limits<double>::infinity();
  return answer_ = Answer::maybe;
}

// What deeper levels need.
void PairQuery::keep(const Pose& a, const Pose& b) noexcept {
  if (ordered_by_pose_ && !one_tree_) order_copies(a, b);
  exchanged_ = one_tree_ ? before(b, a) : arguments_exchanged_;
  first_pose_ = exchanged_ ? b : a;
  second_pose_ = exchanged_ ? a : b;
  placed_ = false;
  leaves_.clear();
  next_.clear();
  cursor_ = {};
  leaf_best_ = {};
  best_ = {separation_bound_, {0, 0}};
  triangle_first_ = triangle_second_ = kNoTriangle;
  stack_size_ = 0;
  pruned_gap_ = std::numeric_limits<double>::infinity();
}

// Copies of one tree change places together with their poses: should the fingerprints of different trees ever agree,
// each keeps its own.
void PairQuery::order_copies(const Pose& a, const Pose& b) noexcept {
  if (before(b, a) == arguments_exchanged_) return;
  arguments_exchanged_ = !arguments_exchanged_;
  std::swap(first_, second_);
  std::swap(prints_[0], prints_[1]);
  for (auto& pair : roots_) std::swap(pair[0], pair[1]);
}

// Along directions that what is in the way suggests (Chung and Wang 1996), as long as these get better. Times the
// distance of the roots' centres: reaches are proportional to the direction's length, and reflecting keeps it. `u`: the
// way at first, and the direction of a gap at last.
double PairQuery::hulls_gap(const Pose& first, const Pose& second, const Vec3& way, Vec3& u) const noexcept {
  const auto support_of = [](const Side& side, const Pose& pose, const Vec3& v) {
    const Vec3 direction = turned_back(pose, v);
    detail::Support support = detail::support_along(side.tree.supports, direction);
    support.most = pose.scale * (support.most - dot(direction, side.middle));
    support.point = rotate(pose, minus(support.point, side.middle));
    for (double& component : support.point) component *= pose.scale;
    return support;  // from the root's centre, in the world
  };
  double best = -std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < kRootDirections; ++turn) {
    const detail::Support p = support_of(*first_, first, u), q = support_of(*second_, second, -u);
    const double gap = dot(u, way) - (p.most + q.most);
    if (gap > 0) return gap;
    if (gap <= best) break;
    best = gap;
    // From the point of the first one to that of the second one; reflecting the direction in it turns these apart.
    const Vec3 apart = minus(q.point, p.point), between = {way[0] + apart[0], way[1] + apart[1], way[2] + apart[2]};
    const double square = dot(between, between), component = dot(between, u);
    if (component >= 0 || !(square > 0)) break;
    const double factor = 2 * component / square;
    for (std::size_t i = 0; i < 3; ++i) u[i] -= factor * between[i];
  }
  return best;
}

}  // namespace orchard::runtime
