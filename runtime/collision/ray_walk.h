#pragma once
#include <bit>
#include <cstdint>

#include "collision/kernels/ray_block.h"
#include "collision/tree_walk.h"
#include "simd/vector_support.h"

// Rays in the frame of a body, and walks along them through its triangles.
namespace orchard::runtime::detail {

// The direction of a ray, scaled by a power of two to a length of about 1. So directions of any length are as accurate
// as unit vectors.
struct Direction {
  Direction(const Vec3& direction, double pose_scale) noexcept : scale(pose_scale) {
    const double largest = max_abs(direction);
    power = largest > 0 && std::isfinite(largest) ? exponent_of(largest) : 0;
    for (std::size_t i = 0; i < 3; ++i) way[i] = scaled(direction[i], -power);
  }
  Direction(double pose_scale, int power_of_two) noexcept : scale(pose_scale), power(power_of_two) {}
  // These convert a multiple of the given direction to a multiple of the scaled one in the body's frame ("steps"), and
  // back.
  double steps(double along) const noexcept {
    if (!(along > 0) || !std::isfinite(along)) return along;
    const int p = exponent_of(along), q = exponent_of(scale);
    const double part = scaled(along, -p);
    return scaled(scale == 1 ? part : part / scaled(scale, -q), p - q + power);
  }
  double along(double steps) const noexcept { return scaled(steps * scale, -power); }

  Vec3 way{};
  double scale;
  int power = 0;
};

// Returns a distance from a point that certainly leads past the whole body.
inline double reach_beyond(const Ball& ball, double bounding_radius, const Vec3& point) noexcept {
  return length(minus(point, ball.middle)) + 2 * ball.radius + kRounding * bounding_radius;
}

// A ray for the tests in float. Its parameter s is a length.
struct Line {
  FloatRay ray;
  double at = 0;             // where s = 0 is: the length along the ray from its origin
  float begin = 0, end = 0;  // the range of s that is searched; both are above 0
  // The ray certainly misses the whole tree; floats can hold the coordinates.
  bool misses = false, in_float = true;
};

// Returns the line from `from` along the unit vector `way`, of the length `length_of_ray`, for triangles in `ball`. Its
// s = 0 is before the ball.
inline Line line_of(const Ball& ball, const Vec3& from, const Vec3& way, double length_of_ray) noexcept {
  constexpr double unit = 0x1p-24;
  Line line;
  const Vec3 to_middle = minus(ball.middle, from);
  const double ahead = dot(to_middle, way), middle = one_norm(ball.middle);
  const double error = kRounding * (2 * one_norm(to_middle) + 2 * middle + ball.radius);
  const double size = middle + 2 * ball.radius + error;
  const double margin = max(48 * unit * size + 2 * error, 1e-15), reach = ball.radius + margin;
  const Vec3 aside = along(to_middle, way, -ahead);
  const double before = reach + 3 * margin;
  line.at = ahead - before;
  for (std::size_t i = 0; i < 3; ++i) {
    line.ray.origin[i] = static_cast<float>(ball.middle[i] - aside[i] - before * way[i]);
    line.ray.direction[i] = static_cast<float>(way[i]);
  }
  line.ray.margin = static_cast<float>(margin * (1 + 4 * unit));
  line.begin = static_cast<float>(max(-line.at, 2 * margin) - margin);
  line.end = static_cast<float>(min(length_of_ray - line.at, 2 * before) + margin);
  line.in_float = size <= kFloatReach;
  const bool beside = dot(aside, aside) > reach * reach * (1 + kRounding), none = line.end < line.begin;
  line.misses = line.in_float & (beside | none);
  return line;
}

// A ray in the body's frame. It is the segment from `from` to `to`, which always ends beyond the whole body, so the end
// of the given ray does not change its direction by rounding. The given ray ends after `end` steps.
struct RayStart {
  Vec3 from{}, to{}, step{};
  double speed = 0, slowness = 0;  // the step's length, and 1 over it or 0
  double end = 0;
  Line line;

  double steps_to(const Vec3& place) const noexcept { return dot(minus(place, from), step) * slowness * slowness; }
};

// Returns the ray from `origin` for `steps` along `way`, both as in Direction. It has no branches, so a loop over
// several rays becomes one over vectors of them.
ORCHARD_INLINE RayStart start_of(const Frame& frame, const Ball& ball, const Vec3& origin, const Vec3& way,
                                 double steps) noexcept {
  RayStart start;
  start.from = frame.enter(origin);
  start.step = rotate(frame.back, way);
  start.speed = length(start.step);
  const bool moves = start.speed > 0;
  start.slowness = (moves ? 1.0 : 0.0) / (moves ? start.speed : 1.0);
  // So many steps that short coordinates stay exact: a ray in a triangle's plane is to end in it.
  const double reach = power_above(reach_beyond(ball, frame.bounding_radius, start.from) * start.slowness);
  start.end = moves ? min(steps, reach) : 0.0;
  start.to = settled(along(start.from, start.step, moves ? reach : 0.0));
  Vec3 unit = along({0, 0, 0}, start.step, start.slowness);
  unit[0] = moves ? unit[0] : 1.0;
  start.line = line_of(ball, start.from, unit, start.end * start.speed);
  return start;
}

// Eight rays, stored member by member.
struct RayStarts {
  static constexpr std::size_t kCount = 8;
  using Row = std::array<double, kCount>;
  using FloatRow = std::array<float, kCount>;

  std::array<Row, 3> origin, way;  // these and `steps` are the input of find_starts()
  Row steps;
  std::array<Row, 3> from, to, step;  // these and the members below are its output
  Row speed, slowness, end;
  struct Lines {
    Row at;
    std::array<FloatRow, 3> origin, direction;
    FloatRow margin, begin, end, misses, in_float;
  };
  Lines lines;

  RayStart at_lane(std::size_t i) const noexcept {
    RayStart start;
    for (std::size_t k = 0; k < 3; ++k) {
      start.from[k] = from[k][i], start.to[k] = to[k][i], start.step[k] = step[k][i];
      start.line.ray.origin[k] = lines.origin[k][i], start.line.ray.direction[k] = lines.direction[k][i];
    }
    start.speed = speed[i], start.slowness = slowness[i], start.end = end[i];
    start.line.at = lines.at[i], start.line.ray.margin = lines.margin[i];
    start.line.begin = lines.begin[i], start.line.end = lines.end[i];
    start.line.misses = lines.misses[i] != 0, start.line.in_float = lines.in_float[i] != 0;
    return start;
  }
};
void find_starts(const Frame& frame, const Ball& ball, RayStarts& starts) noexcept;

// Calls visit(leaf, end) for the leaves of which the ray may meet triangles, the nearest ball slab of a block first.
// visit() returns the s up to which the search goes on, or a value below 0 to end it.
template <typename Visit>
void walk_ray(const TreeView& tree, const Line& line, Visit&& visit) noexcept {
  RayWalk walk(line.ray, line.begin, line.end, tree.obb_nodes[0].child[0]);
  for (RayLeaf leaf = next_leaf(tree, walk); leaf.block != nullptr; leaf = next_leaf(tree, walk)) {
    walk.end = visit(leaf, walk.end);
  }
}

// The triangles of a tree, with the functions that queries along rays need.
struct TreeTriangles {
  const TreeView& tree;

  Frame frame(const Pose& pose) const noexcept { return {tree, pose}; }
  Ball ball() const noexcept { return ball_around(tree); }
  template <typename Visit>
  void along(const Line& line, Visit&& visit) const noexcept {
    walk_ray(tree, line, visit);
  }
  std::span<const TriangleBlock> all() const noexcept { return tree.triangle_blocks; }
};

// Calls visit(points, triangle, certain, end) for the triangles that a line may meet, or for all triangles if floats
// cannot hold the coordinates. `certain` is whether the line certainly passes through the triangle. visit() returns the
// new end, as for walk_ray().
template <typename Triangles, typename Visit>
void each_triangle_along(const Triangles& triangles, const Line& line, Visit&& visit) noexcept {
  if (!line.in_float) {
    each_triangle(triangles.all(), [&](const TrianglePoints& points, std::uint32_t triangle) {
      return visit(points, triangle, false, line.end) >= 0;
    });
    return;
  }
  triangles.along(line, [&](const RayLeaf& leaf, float end) {
    for (std::uint32_t left = leaf.some; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::uint32_t>(std::countr_zero(left));
      end = visit(points_of(*leaf.block, lane), leaf.block->triangle[lane], (leaf.sure >> lane & 1) != 0, end);
    }
    return end;
  });
}

}  // namespace orchard::runtime::detail
