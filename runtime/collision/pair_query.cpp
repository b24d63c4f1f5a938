#include "collision/pair_query.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <type_traits>

#include "collision/kernels/node_box.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

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
// With D = |T| + E1 + E2, which bounds every |c' - a| and r1 + r2, slack = sigma + 8 u D serves all of them. E2, r2 and
// what follows are the second tree's times its relative scale; rounding that product costs r2 another u.
//  (5) Gaps between ball slabs: a moved normal is within 10 u of the true one, and every normal's length within 8.4 u
//  of 1.
//      A height over a ball slab's middle plane is off by at most sigma + 22 u |c' - a|, an extent, which is at most
//      the sum of the radii, by 35 u of itself but for the square of its sine, which kSineError covers, and the sums by
//      4 u D: margin = sigma + 96 u D leaves room, also for two moved points and eight roundings of a triangle test.
//  (6) Gaps between boxes: one of them is turned into the other one's axes, in the first tree's units, and (1) holds
//  for
//      either with sigma + 16 u D. Along a unit vector v the points of a box reach at most the sum of its half sizes
//      times |v . axis|, and besides what the axes lack to be orthonormal (to 1e-6, so 17 u each) times the radius: 51
//      u. An axis is within 10 u of the true one, a product of axes within 25 u, a cosine thus within 30 u, and the sum
//      of three of them, times half sizes of at most a radius each, within 60 u of a radius: 111 u for a radius and so
//      for D. A height is off by sigma + 22 u D, the rest by 6 u D: box_margin = 2 sigma + 192 u D leaves room.
namespace orchard::runtime {

namespace {

constexpr double kFloatUnit = 0x1p-24;
// Keeps the squares of the smallest reach clear of the numbers that a flush-to-zero mode drops.
constexpr double kMinSlack = 1e-15;
constexpr double kCoarse = 0x1p-9;  // of the smaller body's radius; leaves of 1,000 triangles have some 2^-5
constexpr double kMinSize = 1e-18;  // below it Placement::unit stays as it is: margins are far larger

constexpr double kMinOpposition = 1e-6;  // between unit normals: less says nothing about a direction

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

}  // namespace

bool PairQuery::PairList::reserve(std::size_t capacity) noexcept {
  if (capacity <= capacity_) return true;
  capacity = std::max({capacity, 2 * capacity_, std::size_t{64}});
  std::unique_ptr<NodePair[]> larger(new (std::nothrow) NodePair[capacity]);
  if (!larger) return false;
  std::copy_n(pairs_.get(), size_, larger.get());
  pairs_ = std::move(larger);
  capacity_ = capacity;
  return true;
}

PairQuery::PairQuery(std::size_t room) noexcept : refused_(true) {
  answer_ = Answer::maybe;
  if (room > 0) reserve(room);
}

PairQuery::PairQuery(const TreeView& a, const TreeView& b, std::size_t room) noexcept {
  const PreparedTree of_a(a);
  bind(of_a, compare(a, b) == 0 ? of_a : PreparedTree(b));
  reserve(std::max(room, std::size_t{1}));
}

// Whether that is so already: bodies of one shape follow each other often, and to copy costs more than to compare.
bool PairQuery::bound_to(const PreparedTree& a, const PreparedTree& b) const noexcept {
  static_assert(std::is_trivially_copyable_v<PreparedTree>);
  if (ordered_by_pose_ && arguments_exchanged_) return false;  // as the last poses had it
  if (!first_.owns() || !second_.owns()) return false;         // whether those are still there is not known
  const Side &of_a = arguments_exchanged_ ? *second_ : *first_, &of_b = arguments_exchanged_ ? *first_ : *second_;
  // Where only bytes between the members differ, the trees are bound again, which is right too.
  const auto same = [](const Side& x, const Side& y) {
    return std::memcmp(&x, &y, sizeof x) == 0;  // NOLINT(bugprone-suspicious-memory-comparison)
  };
  return a.fingerprint != 0 && same(of_a, a) && same(of_b, b);
}

// The same without a look at what was bound before.
bool PairQuery::bound_where(const PreparedTree& a, const PreparedTree& b) const noexcept {
  if (ordered_by_pose_ && arguments_exchanged_) return false;
  const std::size_t of_a = arguments_exchanged_ ? 1 : 0;
  const BoundSide &side_a = of_a == 0 ? first_ : second_, &side_b = of_a == 0 ? second_ : first_;
  return a.fingerprint != 0 && side_a.refers_to(a) && side_b.refers_to(b) && prints_[of_a] == a.fingerprint &&
         prints_[1 - of_a] == b.fingerprint;
}

void PairQuery::order(const PreparedTree& a, const PreparedTree& b) noexcept {
  ordered_by_pose_ = a.fingerprint == b.fingerprint;
  one_tree_ = ordered_by_pose_ && same_place(a.tree, b.tree);
  arguments_exchanged_ = !ordered_by_pose_ && compare(a.tree, b.tree) > 0;
  const Side &first = arguments_exchanged_ ? b : a, &second = arguments_exchanged_ ? a : b;
  for (std::size_t i = 0; i < 3; ++i) roots_[i] = {first.root[i], second.root[i]};
  prints_ = {first.fingerprint, second.fingerprint};
}

bool PairQuery::bind(const PreparedTree& a, const PreparedTree& b) noexcept {
  if (!bound_to(a, b)) {
    order(a, b);
    const bool exchanged = arguments_exchanged_;
    first_.copy(exchanged ? b : a), second_.copy(exchanged ? a : b);
  }
  return start_over();
}

bool PairQuery::bind_where(const PreparedTree& a, const PreparedTree& b) noexcept {
  if (!bound_where(a, b)) {
    order(a, b);
    first_.refer_to(arguments_exchanged_ ? b : a), second_.refer_to(arguments_exchanged_ ? a : b);
  }
  return start_over();
}

// Nothing is known of what is bound now. False if there is no memory for its stack.
bool PairQuery::start_over() noexcept {
  finished_ = true;
  refused_ = true;
  roots_pending_ = exact_started_ = placed_ = false;
  answer_ = Answer::maybe;
  separation_bound_ = std::numeric_limits<double>::infinity();
  lower_bound_ = 0;
  inner_.clear(), leaves_.clear(), next_.clear();
  settled_leaves_ = 0;
  // Two expanded pairs leave up to eight each in their place, one level deeper in one of the trees; what lies below
  // them is no deeper than they were, so that no depth ever has more than these.
  const std::size_t deepest =
      2 * std::size_t{kBlockWidth} * (first_->tree.triangle_tree_depth + second_->tree.triangle_tree_depth + 1) + 1;
  if (!has_triangles() || deepest <= stack_room_) return true;
  stack_.reset(new (std::nothrow) NodePair[deepest]);
  stack_room_ = stack_ ? deepest : 0;
  return stack_ != nullptr;
}

bool PairQuery::reserve(std::size_t pairs) noexcept {
  pairs += std::size_t{kBlockWidth} * kBlockWidth;  // what one pair of blocks may add
  return inner_.reserve(pairs) && leaves_.reserve(pairs) && next_.reserve(pairs);
}

// The second tree's frame in the first one's, both relative to the trees' origins: these enter here, so that everything
// below works on the trees' own small coordinates.
Pose PairQuery::relative_pose() const noexcept {
  const Pose &first = first_pose_, &second = second_pose_;
  const auto& r = first.rotation;
  const auto& q = second.rotation;
  const double shrink = 1 / first.scale;
  // What is below this is no more than rounding, and without it no product of three coordinates underflows:
  // exact_sign.h.
  const auto settled = [](double value, double least) { return std::fabs(value) < least ? 0.0 : value; };
  Pose relative;
  relative.scale = second.scale * shrink;
  auto offset = transform(second, second_->tree.origin);
  for (std::size_t i = 0; i < 3; ++i) offset[i] -= first.translation[i];
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      relative.rotation[3 * i + j] = settled(r[i] * q[j] + r[3 + i] * q[3 + j] + r[6 + i] * q[6 + j], 0x1p-60);
    }
    relative.translation[i] = settled(
        (r[i] * offset[0] + r[3 + i] * offset[1] + r[6 + i] * offset[2]) * shrink - first_->tree.origin[i], 0x1p-305);
  }
  return relative;
}

// Not needed where the roots decide.
void PairQuery::place() noexcept {
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
  const double distance = length(relative_.translation), second_extent = second_->extent * scale;
  const double sigma = exact_error_ * shrink + kFloatUnit * (10 * second_extent + 6 * distance);
  const double size = distance + first_->extent + second_extent;
  const auto rounded_up = [](double value) {
    return static_cast<float>(std::max(value, kMinSlack) * (1 + 2 * kFloatUnit));
  };
  placement_.slack = rounded_up(sigma + 8 * kFloatUnit * size);
  placement_.margin = rounded_up(2 * sigma + 96 * kFloatUnit * size);
  placement_.box_margin = rounded_up(2 * sigma + 192 * kFloatUnit * size);
  placement_.coarse = double{placement_.box_margin} > kCoarse * std::min(first_->radius, second_->radius * scale);
  const int exponent = 1 + detail::exponent_of(std::max(size, kMinSize));
  detail::find_rows(placement_);
  placement_.unit = static_cast<float>(detail::scaled(1, -exponent));
  placement_.whole = static_cast<float>(detail::scaled(1, exponent));
}

// Whether floats can hold the square of every distance in the pair's frame, and doubles the exact level's products.
// With T and the second extent, origins and errors included, at most 4 L and the first extent below 2.8 L, L =
// kCoordinateLimit, no float sum of squares or of products of two lengths exceeds 120 L^2, a third of the largest
// float.
bool PairQuery::in_range() const noexcept {
  const double relative = second_pose_.scale / first_pose_.scale;
  if (!(relative >= 1 / kMaxRelativeScale && relative <= kMaxRelativeScale)) return false;
  double size = second_->extent * second_pose_.scale + exact_error_;
  for (std::size_t i = 0; i < 3; ++i) {
    size += std::fabs(second_pose_.translation[i] - first_pose_.translation[i]) +
            std::fabs(second_->tree.origin[i]) * second_pose_.scale +
            std::fabs(first_->tree.origin[i]) * first_pose_.scale;
  }
  return size <= 4 * double{kCoordinateLimit} * first_pose_.scale;
}

bool PairQuery::place(const Pose& a, const Pose& b) noexcept {
  start(a, b);
  if (refused_) return false;
  keep(a, b);
  if (!in_range()) return false;
  place();
  return true;
}

bool PairQuery::place_for_triangles(const Pose& a, const Pose& b) noexcept {
  reset_counts();
  find_exact_error(arguments_exchanged_ ? b : a, arguments_exchanged_ ? a : b);
  separation_bound_ = std::numeric_limits<double>::infinity();
  keep(a, b);
  if (!in_range()) return false;
  refused_ = finished_ = false;
  answer_ = Answer::maybe;
  relative_ = relative_pose();
  return true;
}

bool PairQuery::say_yes_if(bool meet) noexcept {
  if (!meet) return false;
  exact_started_ = true;
  finish(Answer::yes);
  return true;
}

void PairQuery::say_no(double lower) noexcept {
  exact_started_ = true;
  finish(Answer::no);
  lower_bound_ = lower;
}

void PairQuery::finish(Answer answer) noexcept {
  answer_ = answer;
  finished_ = true;
  roots_pending_ = false;
  if (answer == Answer::no && !exact_started_) lower_bound_ = pruned_gap_ * (1 - detail::kStretch);
  if (answer == Answer::yes) {
    const double error = first_->tree.vertex_error + second_->tree.vertex_error * relative_.scale;
    separation_bound_ = std::min(separation_bound_, error * first_pose_.scale * (1 + detail::kStretch));
  }
}

Contact PairQuery::contact() const noexcept {
  if (answer_ == Answer::no || refused_) return {};
  Contact contact;
  Vec3 normal{};
  if (answer_ == Answer::yes) {
    contact.center = witness_;
    normal = triangle_normal();
    contact.triangle_a = exchanged_ ? triangle_second_ : triangle_first_;
    contact.triangle_b = exchanged_ ? triangle_first_ : triangle_second_;
  }
  // A "yes" whose triangles say nothing about a direction has that of the spheres.
  if (answer_ != Answer::yes || !(length(normal) > 0)) add_ball(contact, normal);
  for (std::size_t i = 0; i < 3; ++i) contact.center[i] += first_->tree.origin[i];
  if (exchanged_) {
    for (double& component : normal) component = 0 - component;
  }
  contact.center = transform(first_pose_, contact.center);
  contact.radius *= first_pose_.scale;
  contact.normal = rotate(first_pose_, normal);
  return contact;
}

// The ball around the common part of the best pair's spheres, unless triangles meet, and the direction from one to the
// other.
void PairQuery::add_ball(Contact& contact, Vec3& normal) const noexcept {
  const auto [a, b] = best_.pair;
  const auto p = detail::center_of(first_->tree, a);
  const Pose relative = placed_ ? relative_ : relative_pose();
  const auto q = transform(relative, detail::center_of(second_->tree, b));
  const Vec3 way = {q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  const double distance = length(way);
  normal = {1, 0, 0};
  for (std::size_t i = 0; i < 3 && distance > 0; ++i) normal[i] = way[i] / distance;
  if (answer_ == Answer::yes) return;
  const double ra = detail::block_of(first_->tree, a).radius[a % kBlockWidth];
  const double rb = detail::block_of(second_->tree, b).radius[b % kBlockWidth] * relative.scale;
  // The smallest ball around the common part of two balls: one of them if it is less than half cut off, otherwise the
  // ball on the circle in which the spheres cut each other, `at` away from p.
  const double at = distance > 0 ? (distance * distance + ra * ra - rb * rb) / (2 * distance) : 0;
  double share = 0;  // of the way from p to q
  if (distance == 0 || at <= 0 || at >= distance) {
    contact.radius = std::min(ra, rb);
    share = ra <= rb ? 0 : 1;
  } else {
    contact.radius = std::sqrt(std::max(0.0, ra * ra - at * at));
    share = at / distance;
  }
  for (std::size_t i = 0; i < 3; ++i) contact.center[i] = p[i] + share * way[i];
}

// From the first solid to the second one: the first triangle's outward normal less the second one's. Zero if unknown.
Vec3 PairQuery::triangle_normal() const noexcept {
  const auto normal_of = [](const detail::TrianglePoints& t) {
    const auto minus = [](const Vec3& p, const Vec3& q) -> Vec3 { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; };
    const auto u = minus(t[1], t[0]), v = minus(t[2], t[0]);
    Vec3 n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double size = length(n);
    for (double& component : n) component = size > 0 ? component / size : 0;
    return n;
  };
  const auto of_first = normal_of(detail::points_of(first_->tree, triangle_first_));
  const auto of_second = rotate(relative_, normal_of(detail::points_of(second_->tree, triangle_second_)));
  Vec3 way{};
  for (std::size_t i = 0; i < 3; ++i) way[i] = of_first[i] - of_second[i];
  const double size = length(way);
  for (double& component : way) component = size > kMinOpposition ? component / size : 0;
  return way;
}

Verdict PairQuery::verdict() const noexcept {
  return {answer_, separation_bound_, lower_bound_, contact(), level_, work_};
}

}  // namespace orchard::runtime
