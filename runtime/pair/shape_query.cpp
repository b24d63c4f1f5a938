#include "orchard/runtime/shape_query.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tree/tree_nodes.h"
#include "triangle_distance.h"
#include "vector_functions.h"

namespace orchard::runtime {

using detail::along;
using detail::dot;
using detail::minus;
using detail::orientation;
using detail::TrianglePoints;
using detail::Vec3;

namespace {

// Patches are left out only beyond this much more than need be, for the rounding of a few operations.
constexpr double kRounding = 1e-12;
// Below this a coordinate is no more than rounding, and without it no product of three underflows: exact_sign.h.
constexpr double kLeastCoordinate = 0x1p-305;
constexpr int kRays = 16;  // directions tried before contains() adds up angles

struct Segment {
  Vec3 p, d;  // from p to p + d
  double square;
  Segment(const Vec3& from, const Vec3& to) noexcept : p(from), d(minus(to, from)), square(dot(d, d)) {}
};

// Lower bound on the distance of a patch from a segment.
double patch_distance(const PatchBlock& block, std::uint32_t lane, const Segment& s) noexcept {
  const Vec3 c = {block.x[lane], block.y[lane], block.z[lane]}, n = {block.nx[lane], block.ny[lane], block.nz[lane]};
  const Vec3 to = minus(c, s.p);
  const double t = s.square > 0 ? std::clamp(dot(to, s.d) / s.square, 0.0, 1.0) : 0;
  const double by_ball = detail::length(minus(to, along({0, 0, 0}, s.d, t))) - double{block.radius[lane]};
  const double begin = -dot(n, to), end = begin + dot(n, s.d);
  const double nearer = begin * end <= 0 ? 0 : std::min(std::fabs(begin), std::fabs(end));
  // The normal's length is 1 to within 5e-7.
  const double by_planes = (nearer - double{block.height[lane]}) * (1 - 1e-6);
  return std::max(by_ball, by_planes);
}

// Calls visit(triangle block) for the leaves whose patches are within limit() of the segment, the nearest child first,
// until it returns false.
template <typename Limit, typename Visit>
void walk(const TreeView& tree, const Segment& segment, double rounding, Limit&& limit, Visit&& visit) noexcept {
  struct Entry {
    double distance;
    std::uint32_t child;
  };
  std::array<Entry, kBlockWidth*(kPatchDepthLimit + 1) + 1> stack;
  std::size_t size = 0;
  const auto push_children = [&](std::uint32_t index) {
    const PatchBlock& block = tree.patches[index];
    const std::size_t begin = size;
    for (std::uint32_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
      const double distance = patch_distance(block, lane, segment);
      if (distance > limit() * (1 + kRounding) + rounding) continue;
      std::size_t at = size++;
      for (; at > begin && stack[at - 1].distance < distance; --at) stack[at] = stack[at - 1];
      stack[at] = {distance, block.child[lane]};
    }
  };
  push_children(0);
  while (size > 0) {
    const Entry entry = stack[--size];
    if (entry.distance > limit() * (1 + kRounding) + rounding) continue;
    if ((entry.child & kLeafBit) == 0) {
      push_children(entry.child);
    } else if (!visit(tree.triangle_blocks[entry.child & ~kLeafBit])) {
      return;
    }
  }
}

TrianglePoints points_of(const TriangleBlock& block, std::uint32_t lane) noexcept {
  TrianglePoints t{};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < 3; ++i) t[k][i] = double{block.corner[k][i][lane]};
  }
  return t;
}

template <typename Visit>
bool each_triangle(const TriangleBlock& block, Visit&& visit) noexcept {
  for (std::uint32_t lane = 0; lane < kBlockWidth && block.triangle[lane] != kNoTriangle; ++lane) {
    if (!visit(points_of(block, lane), block.triangle[lane])) return false;
  }
  return true;
}

Vec3 settled(Vec3 v) noexcept {
  for (double& x : v) x = std::fabs(x) < kLeastCoordinate ? 0 : x;
  return v;
}

bool within_reach(const Vec3& v) noexcept {  // false for what is not a number
  return std::fabs(v[0]) <= kFarthest && std::fabs(v[1]) <= kFarthest && std::fabs(v[2]) <= kFarthest;
}

struct Frame {  // the body's, with its coordinates relative to the tree's origin
  explicit Frame(const TreeView& view, const Pose& body) noexcept : tree(view), pose(body), back(inverse(body)) {}
  Vec3 enter(const Vec3& world) const noexcept { return settled(minus(transform(back, world), tree.origin)); }
  Vec3 leave(const Vec3& local) const noexcept { return transform(pose, along(local, tree.origin, 1)); }
  double rounding(const Segment& s) const noexcept {
    return kRounding * (detail::length(s.p) + detail::length(s.d) + tree.bounding_radius);
  }
  const TreeView& tree;
  const Pose& pose;
  Pose back;
};

// A ray in the body's frame, by steps of about one unit: directions of every length are as good as unit vectors.
struct Course {
  Course(const Frame& frame, const Vec3& direction) noexcept : scale(frame.pose.scale) {
    const double largest = std::max({std::fabs(direction[0]), std::fabs(direction[1]), std::fabs(direction[2])});
    power = largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
    Vec3 way{};
    for (std::size_t i = 0; i < 3; ++i) way[i] = std::ldexp(direction[i], -power);
    step = rotate(frame.back, way);
    speed = detail::length(step);
  }
  // A factor of the direction in steps, and back.
  double steps(double along) const noexcept {
    if (!std::isfinite(along)) return along;
    int p = 0, q = 0;
    const double ratio = std::frexp(along, &p) / std::frexp(scale, &q);
    return std::ldexp(ratio, p - q + power);
  }
  double along(double steps) const noexcept { return std::ldexp(steps * scale, -power); }
  double steps_to(const Vec3& place) const noexcept { return speed > 0 ? dot(place, step) / (speed * speed) : 0; }

  double scale, speed = 0;
  int power = 0;
  Vec3 step{};
};

// Unit vectors without a pattern, along no axis or diagonal: the multiples of three irrational numbers, modulo 1.
Vec3 ray_direction(int i) noexcept {
  const auto part = [i](double step) {
    const double x = (i + 1) * step;
    return x - std::floor(x) - 0.5;
  };
  const Vec3 v = {part(0.8191725133961645), part(0.6710436067037893), part(0.5497004779019703)};
  return along({0, 0, 0}, v, 1 / detail::length(v));
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
  for (const TriangleBlock& block : tree.triangle_blocks) {
    each_triangle(block, [&](const TrianglePoints& t, std::uint32_t) {
      const Vec3 a = minus(t[0], point), b = minus(t[1], point), c = minus(t[2], point);
      const double la = detail::length(a), lb = detail::length(b), lc = detail::length(c);
      const double volume =
          a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
      sum += 2 * std::atan2(volume, la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
      return true;
    });
  }
  return sum;
}

double reach_beyond(const TreeView& tree, const Vec3& point) noexcept {  // from the point to outside of everything
  const PatchBlock& root = tree.patches[0];
  return detail::length(minus(point, {root.x[0], root.y[0], root.z[0]})) + 2 * double{root.radius[0]} +
         kRounding * tree.bounding_radius;
}

}  // namespace

bool can_ask(const TreeView& tree, const Pose& pose, const std::array<double, 3>& place) noexcept {
  return is_rigid(pose) && within_reach(Frame(tree, pose).enter(place));
}

SurfacePoint nearest_point_to_segment(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                                      const std::array<double, 3>& q, double limit) noexcept {
  SurfacePoint best;
  if (tree.patches.empty()) return best;
  const SurfacePoint unknown{0, {}, kNoTriangle};
  if (!is_rigid(pose) || std::isnan(limit)) return unknown;
  const Frame frame(tree, pose);
  const Vec3 from = frame.enter(p), to = frame.enter(q);
  if (!within_reach(from) || !within_reach(to)) return unknown;
  const Segment segment(from, to);
  const TrianglePoints shape = {from, to, to};
  double least = limit / pose.scale;
  walk(
      tree, segment, frame.rounding(segment), [&] { return least; },
      [&](const TriangleBlock& block) {
        return each_triangle(block, [&](const TrianglePoints& t, std::uint32_t triangle) {
          detail::NearestPoints near = detail::nearest_points(shape, t);
          Vec3 common{};
          if (detail::triangles_intersect(shape, t, &common)) near = {0, common, common};
          if (near.distance > least || (near.distance == least && best.triangle != kNoTriangle)) return true;
          least = near.distance;
          best = {least * pose.scale, near.on_b, triangle};
          return least > 0;
        });
      });
  if (best.triangle != kNoTriangle) best.point = frame.leave(best.point);
  return best;
}

SurfacePoint nearest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& center,
                           double limit) noexcept {
  return nearest_point_to_segment(tree, pose, center, center, limit);
}

std::optional<RayHit> cast_ray(const TreeView& tree, const Pose& pose, const std::array<double, 3>& origin,
                               const std::array<double, 3>& direction, double longest) noexcept {
  if (tree.patches.empty()) return std::nullopt;
  const RayHit unknown{0, origin, kNoTriangle};
  if (!is_rigid(pose) || std::isnan(longest)) return unknown;
  const Frame frame(tree, pose);
  const Vec3 from = frame.enter(origin);
  const Course course(frame, direction);
  if (!within_reach(from) || !std::isfinite(course.speed)) return unknown;
  if (longest < 0) return std::nullopt;
  const double end = course.speed > 0 ? std::min(course.steps(longest), reach_beyond(tree, from) / course.speed) : 0;
  const Vec3 to = settled(along(from, course.step, end));
  std::optional<RayHit> best;
  const Segment whole(from, to);
  const TrianglePoints shape = {from, to, to};
  walk(
      tree, whole, frame.rounding(whole), [] { return 0.0; },
      [&](const TriangleBlock& block) {
        return each_triangle(block, [&](const TrianglePoints& t, std::uint32_t triangle) {
          Vec3 common{};
          if (!detail::triangles_intersect(shape, t, &common)) return true;
          const double steps = std::clamp(course.steps_to(minus(common, from)), 0.0, end);
          const double along = std::min(course.along(steps), longest);
          if (!best || along < best->along) best = RayHit{along, frame.leave(common), triangle};
          return true;
        });
      });
  return best;
}

bool contains(const TreeView& solid, const Pose& pose, const std::array<double, 3>& point) noexcept {
  if (solid.patches.empty()) return false;
  if (!is_rigid(pose)) return true;
  const Frame frame(solid, pose);
  const Vec3 p = frame.enter(point);
  if (!within_reach(p)) return true;
  for (int ray = 0; ray < kRays; ++ray) {
    const Vec3 q = settled(along(p, ray_direction(ray), reach_beyond(solid, p)));
    const Segment segment(p, q);
    int winding = 0;
    bool clear = true;
    walk(
        solid, segment, frame.rounding(segment), [] { return 0.0; },
        [&](const TriangleBlock& block) {
          clear = each_triangle(block, [&](const TrianglePoints& t, std::uint32_t) {
            const Crossing kind = crossing(p, q, t);
            winding += (kind == Crossing::leaving) - (kind == Crossing::entering);
            return kind != Crossing::unclear;
          });
          return clear;
        });
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
