#include "detector/simple_pair.h"

#include <algorithm>

#include "collision/segment_query.h"

namespace orchard::runtime::detail {
namespace {

// A bound on the rounding error of a distance from a few operations, relative to the size of the coordinates.
constexpr double kSimpleRounding = 1e-14;

struct Round {  // in the world
  Vec3 p, q;
  double radius;
  Round(const Shape& shape, const Pose& pose) noexcept
      : p(transform(pose, shape.p)), q(transform(pose, shape.q)), radius(shape.radius * pose.scale) {}
};

Vec3 point_of(const Vec3& p, const Vec3& q, double share) noexcept { return p + share * (q - p); }

struct Nearest {
  Vec3 on_a, on_b;
  Vec3 way() const noexcept { return on_b - on_a; }
};

// Returns the nearest points of two segments (Ericson 2005, 5.1.9).
Nearest nearest_of_segments(const Vec3& p1, const Vec3& q1, const Vec3& p2, const Vec3& q2) noexcept {
  const Vec3 d1 = q1 - p1, d2 = q2 - p2, r = p1 - p2;
  const double a = dot(d1, d1), e = dot(d2, d2), f = dot(d2, r);
  if (!(a > 0)) return {p1, nearest_of_segment(p2, q2, p1)};
  if (!(e > 0)) return {nearest_of_segment(p1, q1, p2), p2};
  const double c = dot(d1, r), b = dot(d1, d2), across = a * e - b * b;
  double s = across > 0 ? std::clamp((b * f - c * e) / across, 0.0, 1.0) : 0;
  const double t = std::clamp((b * s + f) / e, 0.0, 1.0);
  s = std::clamp((b * t - c) / a, 0.0, 1.0);
  return {point_of(p1, q1, s), nearest_of_segment(p2, q2, point_of(p1, q1, s))};
}

Vec3 unit(const Vec3& v, const Vec3& otherwise) noexcept {
  const double size = length(v);
  return size > 0 ? (1 / size) * v : otherwise;
}

// Transforms a point into the box's frame at scale 1.
Vec3 in_box(const Pose& pose, const Vec3& point) noexcept { return transform(inverse(pose), point); }

bool holds(const Shape& box, const Pose& pose, const Vec3& point) noexcept {
  const Vec3 at = in_box(pose, point);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(std::fabs(at[i]) <= box.p[i])) return false;
  }
  return true;
}

// Returns the direction from a point inside the box outwards, through the nearest side.
Vec3 way_out(const Shape& box, const Pose& pose, const Vec3& point) noexcept {
  const Vec3 at = in_box(pose, point);
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    if (box.p[i] - std::fabs(at[i]) < box.p[axis] - std::fabs(at[axis])) axis = i;
  }
  Vec3 way{};
  way[axis] = at[axis] < 0 ? -1 : 1;
  return rotate(pose, way);
}

// Returns the nearest points of a solid box (on_a) and of the segment from p to q (on_b), in the box's frame at scale
// 1. The square of the distance, as a function along the segment, is convex, and quadratic between the places where a
// coordinate enters or leaves the box.
Nearest nearest_of_box(const Vec3& half, const Vec3& p, const Vec3& q) noexcept {
  const Vec3 way = q - p;
  if (const double inside = enters_box(-half, half, p, way, 1); inside <= 1) {
    const Vec3 at = point_of(p, q, inside);
    return {at, at};
  }
  const auto slope = [&](double t, double& square) {  // half of the slope at t; sets `square` to its derivative
    double sum = square = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = p[i] + t * way[i], beyond = x - std::clamp(x, -half[i], half[i]);
      sum += beyond * way[i];
      if (beyond != 0) square += way[i] * way[i];
    }
    return sum;
  };
  double low = 0, high = 1, square = 0;
  if (slope(0, square) >= 0) high = 0;
  if (slope(1, square) <= 0) low = 1;
  for (std::size_t i = 0; i < 3 && low < high; ++i) {
    for (const double side : {-half[i], half[i]}) {
      const double t = (side - p[i]) / way[i];
      if (t > low && t < high) (slope(t, square) < 0 ? low : high) = t;
    }
  }
  double t = low >= 1 ? 1 : high;
  if (low < high) {
    const double middle = 0.5 * (low + high), rise = slope(middle, square);
    t = square > 0 ? std::clamp(middle - rise / square, low, high) : middle;
  }
  Nearest near;
  near.on_b = t == 1 ? q : point_of(p, q, t);
  for (std::size_t i = 0; i < 3; ++i) near.on_a[i] = std::clamp(near.on_b[i], -half[i], half[i]);
  return near;
}

Verdict yes_at(const Vec3& center, const Vec3& normal) noexcept {
  return {.answer = Answer::yes, .contact = {.center = center, .normal = normal}, .level = 1};
}

// Returns "no" with a gap that was computed from coordinates of this size. The lower bound allows for the rounding
// error.
Verdict no_with(double gap, double size) noexcept {
  return {.answer = Answer::no,
          .separation_bound = gap,
          .lower_bound = std::max(0.0, gap - kSimpleRounding * size),
          .level = 1};
}

Verdict of_rounds(const Round& a, const Round& b) noexcept {
  const Nearest near = nearest_of_segments(a.p, a.q, b.p, b.q);
  const double distance = length(near.way());
  if (!std::isfinite(distance)) return unknown_verdict();
  if (distance > a.radius + b.radius) {
    return no_with(distance - a.radius - b.radius, length(near.on_a) + length(near.on_b) + distance);
  }
  const Vec3 normal = unit(near.way(), {0, 0, 1});
  // The contact is in the middle of what both shapes have in common along the normal.
  const double from = std::max(0.0, distance - b.radius), to = std::min(distance, a.radius);
  return yes_at(near.on_a + 0.5 * (from + to) * normal, normal);
}

// The normal of a contact points from the box to the round shape.
Verdict of_box(const Shape& box, const Pose& pose, const Round& round) noexcept {
  const Pose back = inverse(pose);
  const Nearest near = nearest_of_box(box.p, transform(back, round.p), transform(back, round.q));
  const double distance = length(near.way()) * pose.scale;
  if (!std::isfinite(distance)) return unknown_verdict();
  if (distance > round.radius) {
    return no_with(distance - round.radius, length(round.p) + length(round.q) + length(Vec3(pose.translation)));
  }
  const Vec3 at = transform(pose, near.on_a);
  if (distance > 0) return yes_at(at, rotate(pose, unit(near.way(), {0, 0, 1})));
  return yes_at(at, way_out(box, pose, at));
}

// The normal of a contact points from the tree to the round shape.
Verdict of_tree(const Shape& shape, const Pose& pose, const Round& round, std::uint32_t guess) noexcept {
  if (shape.kind == ShapeKind::box) return of_box(shape, pose, round);
  if (shape.tree.obb_nodes.empty()) return unknown_verdict();
  const auto [near, beyond] = nearest_to_segment(shape.tree, pose, round.p, round.q, round.radius, guess);
  if (near.triangle != kNoTriangle) {
    const Vec3 core = nearest_of_segment(round.p, round.q, near.point);
    Verdict verdict = yes_at(near.point, unit(core - Vec3(near.point), {0, 0, 1}));
    verdict.contact.triangle_a = near.triangle;
    return verdict;
  }
  if (near.distance == 0) return unknown_verdict();
  const double size = beyond + round.radius + length(round.p) + length(round.q) + length(Vec3(pose.translation));
  Verdict verdict = no_with(beyond - round.radius, size);
  verdict.separation_bound = length(round.p - Vec3(transform(pose, shape.center))) + shape.reach * pose.scale;
  return verdict;
}

// The normal of a contact points into the half-space.
Verdict of_half_space(const Shape& shape, const Pose& pose, const HalfSpace& half) noexcept {
  const SurfacePoint lowest = lowest_point(shape, pose, half);
  if (!std::isfinite(lowest.distance)) return unknown_verdict();
  if (lowest.distance > 0) return no_with(lowest.distance, 0);
  Verdict verdict = yes_at(lowest.point, -1.0 * half.normal);
  verdict.contact.triangle_a = lowest.triangle;
  return verdict;
}

void exchange(Contact& contact) noexcept {
  for (double& x : contact.normal) x = -x;
  std::swap(contact.triangle_a, contact.triangle_b);
}

}  // namespace

Verdict unknown_verdict() noexcept { return {.separation_bound = kInfinity}; }

Verdict test_simple(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    std::uint32_t guess) noexcept {
  if (b.kind == ShapeKind::half_space) return of_half_space(a, pose_a, b.half);
  if (!a.has_tree() && !b.has_tree()) return of_rounds(Round(a, pose_a), Round(b, pose_b));
  if (a.has_tree()) return of_tree(a, pose_a, Round(b, pose_b), guess);
  Verdict verdict = of_tree(b, pose_b, Round(a, pose_a), guess);
  exchange(verdict.contact);
  return verdict;
}

bool inside_box(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b, Contact& contact) noexcept {
  for (const bool second : {true, false}) {
    const Shape &box = second ? b : a, &other = second ? a : b;
    const Pose &pose = second ? pose_b : pose_a, &other_pose = second ? pose_a : pose_b;
    if (box.kind != ShapeKind::box) continue;
    for (const Vec3& piece : other.pieces) {
      const Vec3 point = transform(other_pose, piece);
      if (!holds(box, pose, point)) continue;
      contact = {};
      contact.center = point;
      contact.normal = way_out(box, pose, point);
      if (second) exchange(contact);
      return true;
    }
  }
  return false;
}

// Searches for the least movement of `b` along the normal at which the shapes are apart. `free` is a movement at which
// they are apart; at first, it is the one at which their extents along the normal no longer overlap. `touching` is the
// largest movement at which they are known to touch. Each step tests a movement in between:
// - If the shapes are apart there by some gap, they are apart for as long a way back.
// - If they touch, they touch for as long a way on as the contact is deep in the round shape.
// The movement is just beyond `touching`, or, at every third step, in the middle, because many surfaces may be in the
// way one after another.
double simple_depth(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    const Vec3& normal) noexcept {
  constexpr int kSteps = 120;
  constexpr double kRounding = 1e-12;  // of coordinates and lengths, in the results of other functions
  const double most = std::max(
      0.0, -lowest_point(a, pose_a, {-1.0 * normal, 0}).distance - lowest_point(b, pose_b, {normal, 0}).distance);
  if (!a.has_tree() && !b.has_tree()) return most;
  const bool second = a.has_tree();  // whether `b` is the round shape
  const Round round(second ? b : a, second ? pose_b : pose_a);
  const double slack = kRounding * (most + round.radius + length(round.p) + length(round.q) +
                                    length(Vec3(pose_a.translation)) + length(Vec3(pose_b.translation)));
  double touching = 0, free = most;
  for (int i = 0; i < kSteps && free - touching > 4 * slack; ++i) {
    const double at = i % 3 == 2 ? 0.5 * (touching + free) : touching + 2 * slack;
    const Vec3 way = at * normal;
    Pose moved = pose_b;
    moved.translation = Vec3(pose_b.translation) + way;
    const Verdict verdict = test_simple(a, pose_a, b, moved, kNoTriangle);
    if (verdict.answer == Answer::no) {
      free = std::max(touching, at - std::max(0.0, verdict.lower_bound - slack));
    } else if (verdict.answer == Answer::yes) {
      const Vec3 of_round = second ? way : Vec3{}, center = verdict.contact.center;
      const Vec3 core = nearest_of_segment(round.p + of_round, round.q + of_round, center);
      touching = std::min(free, std::max(at, at + round.radius - length(core - center) - slack));
    } else {
      touching = at;
    }
  }
  return free;
}

}  // namespace orchard::runtime::detail
