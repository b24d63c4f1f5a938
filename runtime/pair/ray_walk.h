#pragma once
#include <bit>
#include <cstdint>

#include "tree/ray_block.h"
#include "tree_walk.h"

// Rays in a body's frame, and how they go through its triangles.
namespace orchard::runtime::detail {

// As std::ilogb and std::ldexp, which the sizes that occur need no call for.
inline int exponent_of(double value) noexcept {  // of a finite value above 0
  const int power = static_cast<int>(std::bit_cast<std::uint64_t>(value) >> 52) - 1023;
  return power > -1023 ? power : std::ilogb(value);
}
inline double scaled(double value, int power) noexcept {
  if (power < -1000 || power > 1000) return std::ldexp(value, power);
  return value * std::bit_cast<double>(static_cast<std::uint64_t>(1023 + power) << 52);
}
inline double one_norm(const Vec3& v) noexcept { return std::fabs(v[0]) + std::fabs(v[1]) + std::fabs(v[2]); }

// A ray in the body's frame, by steps of about one unit: directions of every length are as good as unit vectors.
struct Course {
  Course(const Frame& frame, const Vec3& direction) noexcept : scale(frame.pose.scale) {
    const double largest = largest_size(direction);
    power = largest > 0 && std::isfinite(largest) ? exponent_of(largest) : 0;
    Vec3 way{};
    for (std::size_t i = 0; i < 3; ++i) way[i] = scaled(direction[i], -power);
    step = rotate(frame.back, way);
    speed = length(step);
    slowness = speed > 0 ? 1 / speed : 0;
  }
  // A factor of the direction in steps, and back.
  double steps(double along) const noexcept {
    if (!(along > 0) || !std::isfinite(along)) return along;
    const int p = exponent_of(along), q = exponent_of(scale);
    const double part = scaled(along, -p);
    return scaled(scale == 1 ? part : part / scaled(scale, -q), p - q + power);
  }
  double along(double steps) const noexcept { return scaled(steps * scale, -power); }
  double steps_to(const Vec3& place) const noexcept { return dot(place, step) * slowness * slowness; }

  double scale, speed = 0, slowness = 0;
  int power = 0;
  Vec3 step{};
};

// A ball around all triangles of a body, in its frame.
struct Ball {
  Vec3 middle{};
  double radius = 0;
};
inline Ball ball_around(const TreeView& tree) noexcept {
  const BallSlabBlock& root = tree.ball_slabs[0];
  return {{root.x[0], root.y[0], root.z[0]}, double{root.radius[0]}};
}

// From a point to outside of everything.
inline double reach_beyond(const Ball& ball, double bounding_radius, const Vec3& point) noexcept {
  return one_norm(minus(point, ball.middle)) + 2 * ball.radius + kRounding * bounding_radius;
}

// A ray for the float tests, or the verdict that there is none: past the whole tree.
struct Line {
  FloatRay ray;
  double at = 0;             // of s = 0, along the ray from its origin
  float begin = 0, end = 0;  // in s, which is above 0
  bool misses = false, in_float = true;
};

// From `from` along the unit vector `way`, for `length_of_ray`, through what is in `ball`; its s = 0 is before it.
inline Line line_of(const Ball& ball, const Vec3& from, const Vec3& way, double length_of_ray) noexcept {
  constexpr double unit = 0x1p-24;
  Line line;
  const Vec3 to_middle = minus(ball.middle, from);
  const double ahead = dot(to_middle, way), middle = one_norm(ball.middle);
  const double error = kRounding * (2 * one_norm(to_middle) + 2 * middle + ball.radius);
  const double size = middle + 2 * ball.radius + error;
  if (!(size <= kFloatReach)) {
    line.in_float = false;
    return line;
  }
  const double margin = more_of(48 * unit * size + 2 * error, 1e-15), reach = ball.radius + margin;
  const Vec3 aside = along(to_middle, way, -ahead);
  const double before = reach + 3 * margin;
  line.at = ahead - before;
  for (std::size_t i = 0; i < 3; ++i) {
    line.ray.origin[i] = static_cast<float>(ball.middle[i] - aside[i] - before * way[i]);
    line.ray.direction[i] = static_cast<float>(way[i]);
  }
  line.ray.margin = static_cast<float>(margin * (1 + 4 * unit));
  line.begin = static_cast<float>(more_of(-line.at, 2 * margin) - margin);
  line.end = static_cast<float>(less_of(length_of_ray - line.at, 2 * before) + margin);
  line.misses = (dot(aside, aside) > reach * reach * (1 + kRounding)) | (line.end < line.begin);
  return line;
}

// Calls visit(leaf, end) for the leaves on the ray of which triangles may be met, the nearest ball slab of a block first.
// visit() returns up to which s the ray goes on from there, or something below 0.
template <typename Visit>
void walk_ray(const TreeView& tree, const Line& line, Visit&& visit) noexcept {
  RayWalk walk(line.ray, line.begin, line.end, tree.ball_slabs[0].child[0]);
  for (RayLeaf leaf = next_leaf(tree, walk); leaf.block != nullptr; leaf = next_leaf(tree, walk)) {
    walk.end = visit(leaf, walk.end);
  }
}

}  // namespace orchard::runtime::detail
