#include "orchard/runtime/shape_query.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "segment_query.h"
#include "tree_walk.h"
#include "triangle_distance.h"

namespace orchard::runtime {

using namespace detail;

namespace {

constexpr int kRays = 16;  // directions tried before contains() adds up angles

// Unit vectors without a pattern, along no axis or diagonal: the multiples of three irrational numbers, modulo 1.
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

// Exactly, as triangles_intersect() says of the segment, which most triangles lie across or beside.
bool segment_meets(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept {
  const int p = orientation(t[0], t[1], t[2], from), q = orientation(t[0], t[1], t[2], to);
  if (p * q > 0) return false;
  if (p == 0 && q == 0) return triangles_intersect({from, to, to}, t, &common);
  const int a = orientation(from, to, t[0], t[1]), b = orientation(from, to, t[1], t[2]);
  if (a * b < 0) return false;
  const int c = orientation(from, to, t[2], t[0]);
  if (a * c < 0 || b * c < 0) return false;
  const Vec3 normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  const double hp = std::fabs(dot(normal, minus(from, t[0]))), hq = std::fabs(dot(normal, minus(to, t[0])));
  common = detail::along(from, minus(to, from), hp + hq > 0 ? std::clamp(hp / (hp + hq), 0.0, 1.0) : 0);
  return true;
}

double winding_angle(const TreeView& tree, const Vec3& point) noexcept {
  double sum = 0;
  for (const TriangleBlock& block : tree.triangle_blocks) {
    each_triangle(block, [&](const TrianglePoints& t, std::uint32_t) {
      const Vec3 a = minus(t[0], point), b = minus(t[1], point), c = minus(t[2], point);
      const double la = length(a), lb = length(b), lc = length(c);
      const double volume =
          a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
      sum += 2 * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
      return true;
    });
  }
  return sum;
}

double reach_beyond(const TreeView& tree, const Vec3& point) noexcept {  // from the point to outside of everything
  const BallSlabBlock& root = tree.ball_slabs[0];
  return length(minus(point, {root.x[0], root.y[0], root.z[0]})) + 2 * double{root.radius[0]} +
         kRounding * tree.bounding_radius;
}

// The first triangle along rays in one body's frame.
class Caster {
 public:
  Caster(const TreeView& tree, const Pose& pose) noexcept : frame_(tree, pose) {}

  std::optional<RayHit> cast(const Ray& ray) const noexcept {
    const RayHit unknown{0, ray.origin, kNoTriangle};
    if (std::isnan(ray.longest)) return unknown;
    const Vec3 from = frame_.enter(ray.origin);
    const Course course(frame_, ray.direction);
    if (!within_reach(from) || !std::isfinite(course.speed)) return unknown;
    if (ray.longest < 0) return std::nullopt;
    const TreeView& tree = frame_.tree;
    Query query{course, from, from, 0, {}};
    query.end = course.speed > 0 ? std::min(course.steps(ray.longest), reach_beyond(tree, from) / course.speed) : 0;
    query.to = settled(detail::along(from, course.step, query.end));
    const double length_of_ray = query.end * course.speed;
    const Vec3 way = course.speed > 0 ? detail::along({0, 0, 0}, course.step, 1 / course.speed) : Vec3{1, 0, 0};
    const Line line = line_of(tree, from, way, length_of_ray);
    if (line.misses) return std::nullopt;
    if (line.in_float) {
      const double rounding = kRounding * (length(from) + tree.bounding_radius);
      walk_ray(tree, line, [&](const TriangleBlock& block, std::uint32_t some, float end) {
        for (std::uint32_t left = some; left != 0; left &= left - 1) {
          const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
          if (!query.offer(points_of(block, lane), block.triangle[lane])) continue;
          const double s = query.best.steps * course.speed;
          end = std::min(end, static_cast<float>(s + rounding - line.at) + line.ray.margin);
        }
        return end;
      });
    } else {
      const Segment whole(from, query.to);
      walk(
          tree, whole, frame_.rounding(whole), [] { return 0.0; },
          [&](const TriangleBlock& block) {
            return each_triangle(block, [&](const TrianglePoints& t, std::uint32_t triangle) {
              query.offer(t, triangle);
              return true;
            });
          });
    }
    if (query.best.triangle == kNoTriangle) return std::nullopt;
    return RayHit{std::min(course.along(query.best.steps), ray.longest), frame_.leave(query.best.point),
                  query.best.triangle};
  }

 private:
  struct Best {
    double steps = std::numeric_limits<double>::infinity();
    Vec3 point{};
    std::uint32_t triangle = kNoTriangle;
  };
  struct Query {
    const Course& course;
    Vec3 from, to;
    double end;
    Best best;

    // Whether the triangle is the nearest so far; of equally near ones the first in the tree's own order.
    bool offer(const TrianglePoints& t, std::uint32_t triangle) noexcept {
      Vec3 common{};
      if (!segment_meets(from, to, t, common)) return false;
      const double steps = std::clamp(course.steps_to(minus(common, from)), 0.0, end);
      if (steps > best.steps || (steps == best.steps && triangle > best.triangle)) return false;
      best = {steps, common, triangle};
      return true;
    }
  };

  Frame frame_;
};

// The surface point nearest to a segment within `limit`, or the first one found, if `any` will do; `guess` is looked at
// first, and is enough where it meets the segment. `beyond`: see NearestToSegment.
SurfacePoint search_outward(const TreeView& tree, const Pose& pose, const Vec3& p, const Vec3& q, double limit,
                            bool any, std::uint32_t guess = kNoTriangle, double* beyond = nullptr) noexcept {
  SurfacePoint best;
  if (tree.ball_slabs.empty()) return best;
  const SurfacePoint unknown{0, {}, kNoTriangle};
  if (!is_rigid(pose) || std::isnan(limit)) return unknown;
  const Frame frame(tree, pose);
  const Vec3 from = frame.enter(p), to = frame.enter(q);
  if (!within_reach(from) || !within_reach(to)) return unknown;
  const Segment segment(from, to);
  const bool point = from == to;
  double least = limit / pose.scale, rest = std::numeric_limits<double>::infinity();
  std::array<float, 3> direction{};
  // False once nothing nearer is wanted.
  const auto compare = [&](const TrianglePoints& t, std::uint32_t triangle, bool may_meet) {
    Vec3 common{};
    const NearestPoints near = may_meet && segment_meets(from, to, t, common) ? NearestPoints{0, common, common}
                               : point                                        ? nearest_points(from, t)
                                                                              : nearest_points(from, to, t);
    if (near.distance > least && beyond != nullptr) {
      rest = std::min(rest, near.distance - kParallelError * (longest_edge(t) + std::sqrt(segment.square)));
    }
    if (near.distance > least || (near.distance == least && triangle > best.triangle)) return true;
    least = near.distance;
    best = {least * pose.scale, near.on_b, triangle};
    for (std::size_t i = 0; i < 3 && least > 0; ++i) {
      direction[i] = static_cast<float>((near.on_b[i] - near.on_a[i]) / least);
    }
    return !any;
  };
  if (guess < tree.triangles.size()) {
    compare(points_of(tree, guess), guess, true);
    if (best.triangle == guess && least == 0) {
      best.point = frame.leave(best.point);
      return best;
    }
  }
  const double size = length(from) + length(to) + length(tree.origin) + tree.bounding_radius;
  if (size <= kFloatReach) {
    const float others = walk_outward(
        tree, shape_of(tree, segment), [&] { return least; },
        [&]() -> const std::array<float, 3>& { return direction; },
        [&](const TriangleBlock& block, std::uint32_t lane, bool may_meet) {
          return compare(points_of(block, lane), block.triangle[lane], may_meet);
        });
    rest = std::min(rest, double{others});
  } else {
    walk(
        tree, segment, frame.rounding(segment), [&] { return least; },
        [&](const TriangleBlock& block) {
          return each_triangle(
              block, [&](const TrianglePoints& t, std::uint32_t triangle) { return compare(t, triangle, true); });
        });
    rest = 0;
  }
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
  return search_outward(tree, pose, p, q, limit, false);
}

detail::NearestToSegment detail::nearest_to_segment(const TreeView& tree, const Pose& pose,
                                                    const std::array<double, 3>& p, const std::array<double, 3>& q,
                                                    double limit, std::uint32_t guess) noexcept {
  NearestToSegment result;
  result.point = search_outward(tree, pose, p, q, limit, false, guess, &result.beyond);
  return result;
}

SurfacePoint nearest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& center,
                           double limit) noexcept {
  return nearest_point_to_segment(tree, pose, center, center, limit);
}

Answer touches_capsule(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                       const std::array<double, 3>& q, double radius) noexcept {
  const SurfacePoint found = search_outward(tree, pose, p, q, radius, true);
  if (found.triangle != kNoTriangle) return Answer::yes;
  return found.distance == 0 ? Answer::maybe : Answer::no;
}

std::optional<RayHit> cast_ray(const TreeView& tree, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction, double longest) noexcept {
  if (tree.ball_slabs.empty()) return std::nullopt;
  if (!is_rigid(pose)) return RayHit{0, origin, kNoTriangle};
  return Caster(tree, pose).cast({origin, direction, longest});
}

void cast_rays(const TreeView& tree, const Pose& pose, std::span<const Ray> rays,
               std::span<std::optional<RayHit>> hits) noexcept {
  const bool rigid = is_rigid(pose);
  const Caster caster(tree, pose);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (tree.ball_slabs.empty()) {
      hits[i] = std::nullopt;
    } else if (rigid) {
      hits[i] = caster.cast(rays[i]);
    } else {
      hits[i] = RayHit{0, rays[i].origin, kNoTriangle};
    }
  }
}

bool contains(const TreeView& solid, const Pose& pose, const std::array<double, 3>& point) noexcept {
  if (solid.ball_slabs.empty()) return false;
  if (!is_rigid(pose)) return true;
  const Frame frame(solid, pose);
  const Vec3 p = frame.enter(point);
  if (!within_reach(p)) return true;
  const double reach = reach_beyond(solid, p);
  for (int ray = 0; ray < kRays; ++ray) {
    const Vec3 way = ray_direction(ray), q = settled(along(p, way, reach));
    int winding = 0;
    bool clear = true;
    const auto count = [&](const TrianglePoints& t) {
      const Crossing kind = crossing(p, q, t);
      winding += (kind == Crossing::leaving) - (kind == Crossing::entering);
      clear = clear && kind != Crossing::unclear;
    };
    const Line line = line_of(solid, p, way, reach);
    if (line.misses) return false;
    if (line.in_float) {
      walk_ray(solid, line, [&](const TriangleBlock& block, std::uint32_t some, float end) {
        for (std::uint32_t left = some; left != 0; left &= left - 1) {
          count(points_of(block, static_cast<std::uint32_t>(std::countr_zero(left))));
        }
        return clear ? end : -std::numeric_limits<float>::infinity();
      });
    } else {
      const Segment segment(p, q);
      walk(
          solid, segment, frame.rounding(segment), [] { return 0.0; },
          [&](const TriangleBlock& block) {
            each_triangle(block, [&](const TrianglePoints& t, std::uint32_t) {
              count(t);
              return clear;
            });
            return clear;
          });
    }
    if (clear) return winding > 0;
  }
  return winding_angle(solid, p) > 2 * std::numbers::pi;
}

bool contains_solid(const TreeView& solid, const Pose& pose, const TreeView& inner, const Pose& inner_pose) noexcept {
  if (inner.triangles.empty()) return false;
  if (!is_rigid(inner_pose)) return true;
  const auto& corner = inner.vertices[inner.triangles[0][0]];
  std::array<double, 3> point{};
  for (std::size_t i = 0; i < 3; ++i) point[i] = double{corner[i]} + inner.origin[i];
  return contains(solid, pose, transform(inner_pose, point));
}

}  // namespace orchard::runtime
