#include "orchard/runtime/shape_query.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "collision/ray_walk.h"
#include "collision/segment_meets.h"
#include "collision/segment_query.h"
#include "collision/triangle_distance.h"

namespace orchard::runtime {

using namespace detail;

namespace {

constexpr int kRays = 16;  // the number of directions that contains() tries before it adds up angles

// Returns unit vectors without a pattern, along no axis or diagonal. Their components are proportional to multiples of
// three irrational numbers, modulo 1.
Vec3 ray_direction(int i) noexcept {
  const auto part = [i](double step) {
    const double x = (i + 1) * step;
    return x - std::floor(x) - 0.5;
  };
  const Vec3 v = {part(0.8191725133961645), part(0.6710436067037893), part(0.5497004779019703)};
  return along({0, 0, 0}, v, 1 / length(v));
}

enum class Crossing { none, leaving, entering, unclear };

Crossing crossing(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  const int side_p = orientation(t[0], t[1], t[2], p), side_q = orientation(t[0], t[1], t[2], q);
  if (side_p * side_q > 0) return Crossing::none;
  const int a = orientation(p, q, t[0], t[1]), b = orientation(p, q, t[1], t[2]), c = orientation(p, q, t[2], t[0]);
  const bool mixed = std::max({a, b, c}) > 0 && std::min({a, b, c}) < 0;
  if (mixed) return Crossing::none;
  if (side_p == 0 || side_q == 0 || a == 0 || b == 0 || c == 0) return Crossing::unclear;
  return side_p > 0 ? Crossing::leaving : Crossing::entering;
}

double winding_angle(const TreeView& tree, const Vec3& point) noexcept {
  double sum = 0;
  each_triangle(tree.triangle_blocks, [&](const TrianglePoints& t, std::uint32_t) {
    const Vec3 a = minus(t[0], point), b = minus(t[1], point), c = minus(t[2], point);
    const double la = length(a), lb = length(b), lc = length(c);
    sum += 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    return true;
  });
  return sum;
}

// Returns the surface point nearest to a segment within `limit` or, if `any` is true, the first one found. The triangle
// `guess` is tested first; if it meets the segment, the search ends. `beyond` is set as in NearestToSegment. `rigid` is
// whether the pose is rigid.
SurfacePoint search_outward(const TreeView& tree, const Pose& pose, bool rigid, const Vec3& p, const Vec3& q,
                            double limit, bool any, std::uint32_t guess = kNoTriangle,
                            double* beyond = nullptr) noexcept {
  SurfacePoint best;
  if (tree.obb_nodes.empty()) return best;
  const SurfacePoint unknown{0, {}, kNoTriangle};
  if (!rigid || std::isnan(limit)) return unknown;
  const Frame frame(tree, pose);
  const Vec3 from = frame.enter(p), to = frame.enter(q);
  if (!within_reach(from) || !within_reach(to)) return unknown;
  const Segment segment(from, to);
  double least = limit / pose.scale, rest = std::numeric_limits<double>::infinity();
  // Compares a triangle with the best one so far. Returns false if the search can end.
  const auto compare = [&](const TrianglePoints& t, std::uint32_t triangle, bool may_meet) {
    Vec3 common{};
    const NearestPoints near =
        may_meet && segment_meets(from, to, t, common) ? NearestPoints{0, common, common} : nearest_points(from, to, t);
    if (near.distance > least && beyond != nullptr) {
      rest = std::min(rest, near.distance - kParallelError * (longest_edge(t) + std::sqrt(segment.square)));
    }
    if (near.distance > least || (near.distance == least && triangle > best.triangle)) return true;
    least = near.distance;
    best = {least * pose.scale, near.on_b, triangle};
    return !any;
  };
  const bool guessed = guess < tree.triangles.size();
  if (guessed) {
    compare(points_of(tree, guess), guess, true);
    if (best.triangle == guess && least == 0) {
      best.point = frame.leave(best.point);
      return best;
    }
  }
  const double size = length(from) + length(to) + length(tree.origin) + tree.bounding_radius;
  const float others = walk_outward(
      tree, segment, [&] { return least; },
      [&](const TriangleBlock& block, std::uint32_t lane, bool may_meet) {
        const std::uint32_t triangle = block.triangle[lane];
        return (guessed && triangle == guess) || compare(points_of(block, lane), triangle, may_meet);
      });
  rest = std::min(rest, double{others});
  if (best.triangle != kNoTriangle) best.point = frame.leave(best.point);
  if (beyond != nullptr) *beyond = std::max(0.0, rest - kRounding * size) * pose.scale;
  return best;
}

}  // namespace

bool can_ask(const TreeView& tree, const Pose& pose, const std::array<double, 3>& place) noexcept {
  return is_rigid(pose) && within_reach(Frame(tree, pose).enter(place));
}

SurfacePoint nearest_point_to_segment(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                                      const std::array<double, 3>& q, double limit) noexcept {
  return search_outward(tree, pose, is_rigid(pose), p, q, limit, false);
}

detail::NearestToSegment detail::nearest_to_segment(const TreeView& tree, const Pose& pose, const Vec3& p,
                                                    const Vec3& q, double limit, std::uint32_t guess) noexcept {
  NearestToSegment result;
  result.point = search_outward(tree, pose, true, p, q, limit, false, guess, &result.beyond);
  return result;
}

SurfacePoint nearest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& center,
                           double limit) noexcept {
  return nearest_point_to_segment(tree, pose, center, center, limit);
}

Answer touches_capsule(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                       const std::array<double, 3>& q, double radius) noexcept {
  const SurfacePoint found = search_outward(tree, pose, is_rigid(pose), p, q, radius, true);
  if (found.triangle != kNoTriangle) return Answer::yes;
  return found.distance == 0 ? Answer::maybe : Answer::no;
}

bool contains(const TreeView& solid, const Pose& pose, const std::array<double, 3>& point) noexcept {
  if (solid.obb_nodes.empty()) return false;
  if (!is_rigid(pose)) return true;
  const Frame frame(solid, pose);
  const Vec3 p = frame.enter(point);
  if (!within_reach(p)) return true;
  const Ball ball = ball_around(solid);
  const double reach = reach_beyond(ball, solid.bounding_radius, p);
  for (int ray = 0; ray < kRays; ++ray) {
    const Vec3 way = ray_direction(ray), q = settled(along(p, way, reach));
    int winding = 0;
    bool clear = true;
    const Line line = line_of(ball, p, way, reach);
    if (line.misses) return false;
    each_triangle_along(TreeTriangles{solid}, line, [&](const TrianglePoints& t, std::uint32_t, bool, float end) {
      const Crossing kind = crossing(p, q, t);
      winding += (kind == Crossing::leaving) - (kind == Crossing::entering);
      clear = clear && kind != Crossing::unclear;
      return clear ? end : -std::numeric_limits<float>::infinity();
    });
    if (clear) return winding > 0;
  }
  return winding_angle(solid, p) > 2 * std::numbers::pi;
}

bool contains_solid(const TreeView& solid, const Pose& pose, const TreeView& inner, const Pose& inner_pose) noexcept {
  if (inner.triangles.empty()) return false;
  if (!is_rigid(inner_pose)) return true;
  return contains(solid, pose, transform(inner_pose, along(points_of(inner, 0)[0], inner.origin, 1)));
}

SignedPoint signed_nearest_point(const TreeView& solid, const Pose& pose, const std::array<double, 3>& center,
                                 double limit) noexcept {
  SignedPoint result;
  result.surface = nearest_point(solid, pose, center, limit);
  if (result.surface.triangle == kNoTriangle) return result;
  Vec3 way = detail::minus(center, result.surface.point);
  double size = std::sqrt(dot(way, way));
  const bool inside = size > 0 && contains(solid, pose, center);
  if (!(size > 0)) {
    const TrianglePoints t = points_of(solid, result.surface.triangle);
    way = rotate(pose, detail::cross(t[1] - t[0], t[2] - t[0]));
    size = std::sqrt(dot(way, way));
  }
  if (inside) result.surface.distance = -result.surface.distance;
  for (std::size_t i = 0; i < 3 && size > 0; ++i) result.normal[i] = (inside ? -way[i] : way[i]) / size;
  return result;
}

}  // namespace orchard::runtime
