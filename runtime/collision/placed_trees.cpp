#include "collision/placed_trees.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "collision/support_map.h"
#include "math/rigid_pair.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

// Rounding. Let c be the true place of a centre of the second tree in the first one's frame, c' the one computed in
// float, a a centre of the first tree, u = 2^-24, E1 and E2 the trees' extents, and T the relative translation.
//  (1) |c' - c| <= sigma. A row of the rotation has length 1. So, per component, rounding its entries costs u|q|, and
//      the three products and three sums cost 4.1 u (|q| + |T_i|). With the rounding of T itself, this is at most
//      sqrt(3) 5.2 u |q| + 5.2 u |T| <= u (10 E2 + 6 |T|) in all. exact_error below is what double arithmetic adds, and
//      poses that are rigid only to kRigidTolerance.
//  (2) square is at most |c' - a|^2 (1 + 5.1 u), and reach is at least (r1 + r2 + slack)(1 - 2 u). If the balls touch,
//      |c' - a| <= r1 + r2 + sigma, so square <= reach * reach, as computed, holds if slack - sigma >= 5.2 u (r1 + r2).
//  (3) If the test fails, the true gap |c - a| - r1 - r2 is at least sqrt(square) - reach, evaluated exactly, if slack
//      - sigma >= 4.1 u |c' - a| + 2.1 u (r1 + r2), which includes the rounding of square - reach * reach.
//  (4) |c - a| <= sqrt(square) + slack if slack - sigma >= 3 u |c' - a|.
// With D = |T| + E1 + E2, which bounds every |c' - a| and r1 + r2, slack = sigma + 8 u D is enough for all of them. E2,
// r2 and the second tree's lengths below are those of the second tree times its relative scale; rounding that product
// costs r2 another u.
//  (5) Triangles against planes of boxes: a moved normal is within 10 u of the true one, and the length of every normal
//      is within 8.4 u of 1. A height over a middle plane of a box is off by at most sigma + 22 u |c' - a|, and the
//      sums by 4 u D. margin = 2 sigma + 96 u D leaves room, also for two moved points and eight roundings of a
//      triangle test.
//  (6) Gaps between boxes: one of the boxes is turned into the other one's axes, in the first tree's units, and (1)
//      holds for either with sigma + 16 u D. Along a unit vector v, the points of a box reach at most the sum of its
//      half sizes times |v . axis|, and in addition what the axes lack to be orthonormal (1e-6, so 17 u each) times the
//      radius: 51 u. An axis is within 10 u of the true one, a product of axes within 25 u, a cosine thus within 30 u,
//      and the sum of three of them, times half sizes of at most a radius each, within 60 u of a radius. This makes 111
//      u for a radius and so for D. A height is off by sigma + 22 u D, the rest by 6 u D: box_margin = 2 sigma + 192 u
//      D leaves room.
namespace orchard::runtime {

using detail::minus;
using detail::one_norm;
using detail::turned_back;

namespace {

constexpr double kFloatUnit = 0x1p-24;
// Keeps the squares of the smallest reach above the numbers that a flush-to-zero mode drops.
constexpr double kMinSlack = 1e-15;
constexpr double kCoarse = 0x1p-9;    // of the smaller body's radius; leaves of 1,000 triangles have about 2^-5 of it
constexpr double kMinSize = 1e-18;    // below it Placement::unit stays as it is: margins are far larger
constexpr double kMinError = 1e-150;  // of a length: covers the underflow of its square
constexpr int kRootDirections = 5;    // the number of directions that are tried to separate the hulls

template <typename Container>
int compare_bytes(const Container& a, const Container& b) noexcept {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  if (a.data() == b.data()) return 0;
  return a.empty() ? 0 : std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0]));
}

int compare(const TreeView& a, const TreeView& b) noexcept {
  if (const int c = compare_bytes(a.blocks, b.blocks)) return c;
  if (const int c = compare_bytes(a.triangles, b.triangles)) return c;
  if (const int c = compare_bytes(a.vertices, b.vertices)) return c;
  if (const int c = compare_bytes(a.leaf_triangles, b.leaf_triangles)) return c;
  const std::array<double, 5> da = {a.origin[0], a.origin[1], a.origin[2], a.bounding_radius, a.vertex_error};
  const std::array<double, 5> db = {b.origin[0], b.origin[1], b.origin[2], b.bounding_radius, b.vertex_error};
  return compare_bytes(da, db);
}

bool same_place(const TreeView& a, const TreeView& b) noexcept {
  return a.blocks.data() == b.blocks.data() && a.triangle_blocks.data() == b.triangle_blocks.data() &&
         a.vertices.data() == b.vertices.data() && a.origin == b.origin;
}

bool before(const Pose& a, const Pose& b) noexcept {
  if (a.rotation != b.rotation) return a.rotation < b.rotation;
  return a.translation != b.translation ? a.translation < b.translation : a.scale < b.scale;
}

}  // namespace

const PreparedTree OrderedTrees::kNone{};

void OrderedTrees::bind(const PreparedTree& a, const PreparedTree& b) noexcept {
  equal_ = a.fingerprint == b.fingerprint;
  one_tree_ = equal_ && same_place(a.tree, b.tree);
  exchanged_ = !equal_ && compare(a.tree, b.tree) > 0;
  first_ = exchanged_ ? &b : &a, second_ = exchanged_ ? &a : &b;
  for (std::size_t i = 0; i < 3; ++i) roots_[i] = {first_->root[i], second_->root[i]};
}

// Equal trees are exchanged together with their poses. So, even if the fingerprints of different trees should ever
// agree, each tree keeps its own pose.
bool OrderedTrees::order_at(const Pose& a, const Pose& b) noexcept {
  if (one_tree_) return before(b, a);
  if (!equal_ || before(b, a) == exchanged_) return exchanged_;
  exchanged_ = !exchanged_;
  std::swap(first_, second_);
  for (auto& pair : roots_) std::swap(pair[0], pair[1]);
  return exchanged_;
}

void PlacedTrees::find_exact_error(const Pose& of_first, const Pose& of_second) noexcept {
  exact_error_ = (of_first.scale * first().error + of_second.scale * second().error) +
                 1e-14 * (one_norm(of_first.translation) + one_norm(of_second.translation)) + kMinError;
}

// Computes only what this test needs; place() does the rest. It works in double and in world coordinates, so that
// bodies that are far apart do not overflow. Exchanging the bodies changes no bit of any result, so equal trees need no
// order yet.
Roots::Answer PlacedTrees::test_roots(const Pose& a, const Pose& b, Roots& result) noexcept {
  result = {};
  const bool exchanged = trees_.exchanged();
  const Pose &of_first = exchanged ? b : a, &of_second = exchanged ? a : b;
  const PreparedTree &first = trees_.first(), &second = trees_.second();
  const detail::PoseLanes poses(of_first, of_second);
  const auto refuse = [&] {
    keep(a, b);
    return Roots::Answer::refused;
  };
  // Nothing below holds for other poses, and the tables of the hulls have no entries for directions that are not
  // numbers.
  if (!poses.rotate()) return refuse();
  const auto lanes = [](const std::array<double, 2>& pair) { return detail::Two{pair[0], pair[1]}; };
  const detail::Two roots[3] = {lanes(trees_.roots(0)), lanes(trees_.roots(1)), lanes(trees_.roots(2))};
  Vec3 way{};
  for (std::size_t i = 0; i < 3; ++i) {
    const detail::Two place = poses.placed(i, roots);
    way[i] = place[1] - place[0];
  }
  const double square = dot(way, way), distance = std::sqrt(square);
  const auto sum = [&](double by_first, double by_second) {
    return of_first.scale * by_first + of_second.scale * by_second;
  };
  find_exact_error(of_first, of_second);
  const double radii = sum(first.radius, second.radius);
  const double bound = detail::pair_bound(distance + exact_error_, radii, sum(first.reach, second.reach),
                                          sum(first.depth, second.depth));
  const double ball_gap = distance - radii - exact_error_;
  double gap = ball_gap;
  Vec3 along = way;
  if (gap <= 0 && square > 0 && have_triangles(*this)) {
    // A lower bound on the distance of the bodies' convex hulls, first along the line through the roots' centres.
    const auto reach = [](const PreparedTree& of, const Pose& pose, const Vec3& u) {
      const Vec3 direction = turned_back(pose, u);
      return pose.scale * (detail::reach_along(of.tree.supports, direction) - dot(direction, of.middle));
    };
    gap = square - (reach(first, of_first, way) + reach(second, of_second, -way));
    if (!(gap > 0)) gap = hulls_gap(of_first, of_second, way, along);
    gap = gap / distance * (1 - detail::kStretch) - detail::kStretch * distance - exact_error_;
  }
  result.separation_bound = bound;
  if (gap > 0 && std::isfinite(gap)) {
    result.lower_bound = gap * (1 - detail::kStretch);
    for (std::size_t i = 0; i < 3; ++i) result.apart_along[i] = along[i] / (exchanged ? -distance : distance);
    return Roots::Answer::apart;
  }
  keep(a, b);
  if (std::isfinite(ball_gap) && in_range()) return Roots::Answer::near;
  result.separation_bound = std::numeric_limits<double>::infinity();
  return Roots::Answer::refused;
}

void PlacedTrees::keep(const Pose& a, const Pose& b) noexcept {
  exchanged_ = trees_.order_at(a, b);
  first_pose_ = exchanged_ ? b : a;
  second_pose_ = exchanged_ ? a : b;
  placed_ = false;
}

// Returns a lower bound on the distance of the hulls, times the distance of the roots' centres. It tries directions
// that the points in the way suggest (Chung and Wang 1996), as long as the bounds improve. Reaches are proportional to
// the length of the direction, which is that distance, and reflections keep it. `u` is `way` at first, and the
// direction of the best gap in the end.
double PlacedTrees::hulls_gap(const Pose& of_first, const Pose& of_second, const Vec3& way, Vec3& u) const noexcept {
  const auto support_of = [](const PreparedTree& side, const Pose& pose, const Vec3& v) {
    const Vec3 direction = turned_back(pose, v);
    detail::Support support = detail::support_along(side.tree.supports, direction);
    support.most = pose.scale * (support.most - dot(direction, side.middle));
    support.point = pose.scale * Vec3(rotate(pose, minus(support.point, side.middle)));
    return support;  // from the root's centre, in the world
  };
  double best = -std::numeric_limits<double>::infinity();
  for (int turn = 0; turn < kRootDirections; ++turn) {
    const detail::Support p = support_of(first(), of_first, u), q = support_of(second(), of_second, -u);
    const double gap = dot(u, way) - (p.most + q.most);
    if (gap > 0) return gap;
    if (gap <= best) break;
    best = gap;
    // This leads from the support point of the first body to that of the second one. Reflecting the direction in the
    // plane across it turns these points apart.
    const Vec3 between = way + (q.point - p.point);
    const double square = dot(between, between), component = dot(between, u);
    if (component >= 0 || !(square > 0)) break;
    u = u - (2 * component / square) * between;
  }
  return best;
}

// Both frames are relative to the trees' origins, so that everything below works with the small coordinates of the
// trees.
Pose PlacedTrees::relative_pose() const noexcept {
  const double shrink = 1 / first_pose_.scale;
  // Smaller values are no more than rounding, and without them no product of three coordinates underflows
  // (exact_sign.h).
  const auto settled = [](double value, double least) { return std::fabs(value) < least ? 0.0 : value; };
  Pose relative;
  relative.scale = second_pose_.scale * shrink;
  relative.rotation = detail::product(detail::transposed(first_pose_.rotation), second_pose_.rotation);
  for (double& entry : relative.rotation) entry = settled(entry, 0x1p-60);
  const Vec3 place = transform(second_pose_, second().tree.origin), way = minus(place, first_pose_.translation);
  relative.translation = minus(shrink * turned_back(first_pose_, way), first().tree.origin);
  for (double& coordinate : relative.translation) coordinate = settled(coordinate, 0x1p-305);
  return relative;
}

void PlacedTrees::place() noexcept {
  if (placed_) return;
  placed_ = true;
  relative_ = relative_pose();
  const double shrink = 1 / first_pose_.scale, scale = relative_.scale;
  for (std::size_t i = 0; i < 9; ++i) {
    placement_.turn[i] = static_cast<float>(relative_.rotation[i]);
    placement_.rotation[i] = static_cast<float>(relative_.rotation[i] * scale);
  }
  for (std::size_t i = 0; i < 3; ++i) placement_.translation[i] = static_cast<float>(relative_.translation[i]);
  placement_.scale = static_cast<float>(scale);
  const double distance = length(relative_.translation), second_extent = second().extent * scale;
  const double sigma = exact_error_ * shrink + kFloatUnit * (10 * second_extent + 6 * distance);
  const double size = distance + first().extent + second_extent;
  const auto rounded_up = [](double value) {
    return static_cast<float>(std::max(value, kMinSlack) * (1 + 2 * kFloatUnit));
  };
  placement_.slack = rounded_up(sigma + 8 * kFloatUnit * size);
  placement_.margin = rounded_up(2 * sigma + 96 * kFloatUnit * size);
  placement_.box_margin = rounded_up(2 * sigma + 192 * kFloatUnit * size);
  placement_.coarse = double{placement_.box_margin} > kCoarse * std::min(first().radius, second().radius * scale);
  const int exponent = 1 + detail::exponent_of(std::max(size, kMinSize));
  detail::find_rows(placement_);
  placement_.unit = static_cast<float>(detail::scaled(1, -exponent));
  placement_.whole = static_cast<float>(detail::scaled(1, exponent));
}

// Returns whether floats can hold the square of every distance in the pair's frame, and doubles the products of the
// exact level. T and the second extent, origins and errors included, are at most 4 L, and the first extent is below 2.8
// L, with L = kCoordinateLimit. So no float sum of squares, or of products of two lengths, exceeds 120 L^2, a third of
// the largest float.
bool PlacedTrees::in_range() const noexcept {
  const double relative = second_pose_.scale / first_pose_.scale;
  if (!(relative >= 1 / kMaxRelativeScale && relative <= kMaxRelativeScale)) return false;
  double size = second().extent * second_pose_.scale + exact_error_;
  for (std::size_t i = 0; i < 3; ++i) {
    size += std::fabs(second_pose_.translation[i] - first_pose_.translation[i]) +
            std::fabs(second().tree.origin[i]) * second_pose_.scale +
            std::fabs(first().tree.origin[i]) * first_pose_.scale;
  }
  return size <= 4 * double{kCoordinateLimit} * first_pose_.scale;
}

bool PlacedTrees::place(const Pose& a, const Pose& b) noexcept {
  keep(a, b);
  if (!in_range()) return false;
  place();
  return true;
}

bool PlacedTrees::place_for_triangles(const Pose& a, const Pose& b) noexcept {
  const bool exchanged = trees_.exchanged();
  find_exact_error(exchanged ? b : a, exchanged ? a : b);
  keep(a, b);
  if (!in_range()) return false;
  relative_ = relative_pose();
  return true;
}

}  // namespace orchard::runtime
