#include "orchard/runtime/narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

#include "tree_nodes.h"

// Rounding. Let c be the true place of a centre of the second tree in the first one's frame, c' the one computed in
// float, a a centre of the first tree, u = 2^-24, E1 and E2 the trees' extents, T the relative translation.
//  (1) |c' - c| <= sigma. A row of the rotation has length 1, so per component rounding its entries costs u|q| and the
//      three products and three sums 4.1 u (|q| + |T_i|): together, with the rounding of T itself, at most
//      sqrt(3) 5.2 u |q| + 5.2 u |T| <= u (10 E2 + 6 |T|). What double arithmetic and poses that are rigid only to
//      kRigidTolerance add is exact_error below.
//  (2) square = |c' - a|^2 (1 + 5.1 u) at most and reach = (r1 + r2 + slack)(1 - 2 u) at least. If the balls touch,
//      |c' - a| <= r1 + r2 + sigma, so square <= reach * reach, as computed, holds if slack - sigma >= 5.2 u (r1 +
//      r2).
//  (3) If the test fails, the true gap |c - a| - r1 - r2 is at least sqrt(square) - reach, evaluated exactly, if
//      slack - sigma >= 4.1 u |c' - a| + 2.1 u (r1 + r2), which includes the rounding of square - reach * reach.
//  (4) |c - a| <= sqrt(square) + slack if slack - sigma >= 3 u |c' - a|.
// With D = |T| + E1 + E2, which bounds every |c' - a| and r1 + r2, slack = sigma + 8 u D serves all of them.
namespace orchard::runtime {

using detail::length;

namespace {

constexpr double kFloatUnit = 0x1p-24;
// Keeps the squares of the smallest reach clear of the numbers that a flush-to-zero mode drops.
constexpr double kLeastSlack = 1e-15;
// A bound is stretched by this, since distances under poses rigid to kRigidTolerance are off by up to 3e-12 of them.
constexpr double kStretch = 1e-11;

template <typename Container>
int compare_bytes(const Container& a, const Container& b) noexcept {
  if (a.size() != b.size()) return a.size() < b.size() ? -1 : 1;
  return a.empty() ? 0 : std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0]));
}

int compare(const PackedSphereTree& a, const PackedSphereTree& b) noexcept {
  if (&a == &b) return 0;
  if (const int c = compare_bytes(a.blocks, b.blocks)) return c;
  if (const int c = compare_bytes(a.triangles, b.triangles)) return c;
  if (const int c = compare_bytes(a.vertices, b.vertices)) return c;
  if (const int c = compare_bytes(a.leaf_triangles, b.leaf_triangles)) return c;
  const std::array<double, 5> da = {a.origin[0], a.origin[1], a.origin[2], a.bounding_radius, a.vertex_error};
  const std::array<double, 5> db = {b.origin[0], b.origin[1], b.origin[2], b.bounding_radius, b.vertex_error};
  return compare_bytes(da, db);
}

bool before(const Pose& a, const Pose& b) noexcept {
  return a.rotation != b.rotation ? a.rotation < b.rotation : a.translation < b.translation;
}

}  // namespace

bool NarrowPhase::PairList::reserve(std::size_t capacity) noexcept {
  if (capacity <= capacity_) return true;
  capacity = std::max({capacity, 2 * capacity_, std::size_t{64}});
  std::unique_ptr<NodePair[]> larger(new (std::nothrow) NodePair[capacity]);
  if (!larger) return false;
  std::copy_n(pairs_.get(), size_, larger.get());
  pairs_ = std::move(larger);
  capacity_ = capacity;
  return true;
}

NarrowPhase::Side NarrowPhase::side_of(const PackedSphereTree& tree) noexcept {
  auto root = detail::center_of(tree, 0);
  for (std::size_t i = 0; i < 3; ++i) root[i] += tree.origin[i];
  return {&tree, root, coordinate_extent(tree)};
}

NarrowPhase::NarrowPhase(const PackedSphereTree& a, const PackedSphereTree& b) noexcept {
  const int order = compare(a, b);
  arguments_exchanged_ = order > 0;
  ordered_by_pose_ = order == 0;
  first_ = side_of(a);
  second_ = &a == &b ? first_ : side_of(b);
  const double sizes = first_.extent + second_.extent + length(a.origin) + length(b.origin);
  fixed_error_ = kStretch * sizes + a.vertex_error + b.vertex_error;
  if (arguments_exchanged_) std::swap(first_, second_);
}

bool NarrowPhase::reserve(std::size_t pairs) noexcept {
  return inner_.reserve(pairs) && leaves_.reserve(pairs) && next_.reserve(pairs);
}

void NarrowPhase::set_relative_pose(const Pose& first, const Pose& second, double exact_error) noexcept {
  first_pose_ = first;
  // Origins enter here, so that everything below works on the trees' own small coordinates.
  auto offset = transform(second, second_.tree->origin);
  for (std::size_t i = 0; i < 3; ++i) offset[i] -= first.translation[i];
  Pose back = inverse(first);
  back.translation = {0, 0, 0};
  relative_ = compose(back, second);
  relative_.translation = rotate(back, offset);
  for (std::size_t i = 0; i < 3; ++i) relative_.translation[i] -= first_.tree->origin[i];

  for (std::size_t i = 0; i < 9; ++i) placement_.rotation[i] = static_cast<float>(relative_.rotation[i]);
  for (std::size_t i = 0; i < 3; ++i) placement_.translation[i] = static_cast<float>(relative_.translation[i]);
  const double distance = length(relative_.translation);
  const double sigma = exact_error + kFloatUnit * (10 * second_.extent + 6 * distance);
  const double slack = sigma + 8 * kFloatUnit * (distance + first_.extent + second_.extent);
  placement_.slack = static_cast<float>(std::max(slack, kLeastSlack) * (1 + 2 * kFloatUnit));
}

void NarrowPhase::reset() noexcept {
  inner_.clear();
  leaves_.clear();
  next_.clear();
  settled_leaves_ = 0;
  cursor_ = {};
  leaf_best_ = {};
  triangle_first_ = triangle_second_ = kNoTriangle;
  finished_ = out_of_memory_ = roots_pending_ = false;
  level_ = 0;
  pair_tests_ = 1;
  triangle_tests_ = 0;
  lower_bound_ = 0;
  pruned_gap_ = std::numeric_limits<double>::infinity();
}

Answer NarrowPhase::start(const Pose& a, const Pose& b) noexcept {
  reset();
  exchanged_ = ordered_by_pose_ ? before(b, a) : arguments_exchanged_;
  const Pose &first = exchanged_ ? b : a, &second = exchanged_ ? a : b;

  // The roots, in double and in the world: bodies that are far apart must not overflow, and most pairs end here.
  const SiblingBlock &p = first_.tree->blocks[0], &q = second_.tree->blocks[0];
  const auto c1 = transform(first, first_.root), c2 = transform(second, second_.root);
  double size = 0;
  for (std::size_t i = 0; i < 3; ++i) size += std::fabs(first.translation[i]) + std::fabs(second.translation[i]);
  const double exact_error = fixed_error_ + 1e-14 * size;
  const double distance = length({c2[0] - c1[0], c2[1] - c1[1], c2[2] - c1[2]});
  const double radii = double{p.radius[0]} + q.radius[0];
  separation_bound_ =
      pair_bound(distance + exact_error, radii, double{p.error[0]} + q.error[0], double{p.depth[0]} + q.depth[0]);
  best_ = {separation_bound_, {0, 0}};
  const double gap = distance - radii - exact_error;
  if (gap > 0 && std::isfinite(gap)) {
    pruned_gap_ = gap;
    finish(Answer::no);
    return answer_;
  }
  answer_ = Answer::maybe;
  roots_pending_ = true;
  // Poses that are not finite, or beyond what can be squared: nothing is certain then and nothing can be refined.
  const bool deeper = !detail::is_leaf(*first_.tree, 0) || !detail::is_leaf(*second_.tree, 0) || has_triangles();
  finished_ = !deeper || !std::isfinite(gap);
  set_relative_pose(first, second, exact_error);
  return answer_;
}

bool NarrowPhase::has_triangles() const noexcept {
  return !first_.tree->triangles.empty() && !second_.tree->triangles.empty();
}

// Also right for pairs that do not meet: a point between the balls is within `errors` plus their gap of both solids.
double NarrowPhase::pair_bound(double distance, double radii, double errors, double depths) noexcept {
  const double bound = std::min(errors + std::max(0.0, distance - radii), depths + distance);
  return std::max(0.0, bound) * (1 + kStretch);
}

void NarrowPhase::finish(Answer answer) noexcept {
  answer_ = answer;
  finished_ = true;
  roots_pending_ = false;
  if (answer == Answer::no) lower_bound_ = triangle_tests_ == 0 ? pruned_gap_ * (1 - kStretch) : 0;
  if (answer == Answer::yes) {
    separation_bound_ = std::min(separation_bound_, first_.tree->vertex_error + second_.tree->vertex_error);
  }
}

Contact NarrowPhase::contact() const noexcept {
  if (answer_ == Answer::no) return {};
  const auto [a, b] = best_.pair;
  const auto p = detail::center_of(*first_.tree, a);
  const auto q = transform(relative_, detail::center_of(*second_.tree, b));
  const double ra = detail::block_of(*first_.tree, a).radius[a % kBlockWidth];
  const double rb = detail::block_of(*second_.tree, b).radius[b % kBlockWidth];
  const std::array<double, 3> way = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  const double distance = length(way);

  // The smallest ball around the common part of two balls: one of them if it is less than half cut off, otherwise the
  // ball on the circle in which the spheres cut each other, `at` away from p.
  const double at = distance > 0 ? (distance * distance + ra * ra - rb * rb) / (2 * distance) : 0;
  Contact contact;
  double share = 0;  // of the way from p to q
  if (distance == 0 || at <= 0 || at >= distance) {
    contact.radius = std::min(ra, rb);
    share = ra <= rb ? 0 : 1;
  } else {
    contact.radius = std::sqrt(std::max(0.0, ra * ra - at * at));
    share = at / distance;
  }
  std::array<double, 3> center{}, normal = {1, 0, 0};
  for (std::size_t i = 0; i < 3; ++i) {
    center[i] = p[i] + share * way[i];
    if (distance > 0) normal[i] = (exchanged_ ? -way[i] : way[i]) / distance;
  }
  if (answer_ == Answer::yes) {
    center = witness_;
    contact.radius = 0;
    contact.triangle_a = exchanged_ ? triangle_second_ : triangle_first_;
    contact.triangle_b = exchanged_ ? triangle_first_ : triangle_second_;
  }
  for (std::size_t i = 0; i < 3; ++i) center[i] += first_.tree->origin[i];
  contact.center = transform(first_pose_, center);
  contact.normal = rotate(first_pose_, normal);
  return contact;
}

}  // namespace orchard::runtime
