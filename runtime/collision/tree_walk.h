#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "collision/kernels/eight.h"
#include "collision/kernels/farthest_first.h"
#include "collision/kernels/node_box.h"
#include "collision/kernels/segment_block.h"
#include "collision/kernels/triangle_block.h"
#include "math/vector_functions.h"
#include "orchard/runtime/shape_query.h"
#include "tree/tree_nodes.h"

// Walks of queries through the triangles of one tree, outward from a point or a segment. Walks along a ray are in
// ray_walk.h.
namespace orchard::runtime::detail {

// The relative rounding error of a few operations in double.
inline constexpr double kRounding = 1e-12;
// Smaller coordinates are replaced by 0. They are no more than rounding, and without them, no product of three
// coordinates underflows (exact_sign.h).
inline constexpr double kMinCoordinate = 0x1p-305;
// If coordinates are larger than this, floats cannot hold the squares of distances, and every triangle is tested.
inline constexpr double kFloatReach = 2e18;
inline constexpr std::size_t kWalkRoom = std::size_t{kBlockWidth} * (kTriangleTreeDepthLimit + 1) + 1;

struct Segment {
  Vec3 p, d;  // from p to p + d
  double square;
  Segment(const Vec3& from, const Vec3& to) noexcept : p(from), d(minus(to, from)), square(dot(d, d)) {}
};

// Calls visit(points, triangle) for the triangles of blocks until it returns false. Returns false in this case, and
// true otherwise.
template <typename Visit>
bool each_triangle(std::span<const TriangleBlock> blocks, Visit&& visit) noexcept {
  for (const TriangleBlock& block : blocks) {
    for (std::uint32_t lane = 0; lane < kBlockWidth && block.triangle[lane] != kNoTriangle; ++lane) {
      if (!visit(points_of(block, lane), block.triangle[lane])) return false;
    }
  }
  return true;
}

inline Vec3 settled(Vec3 v) noexcept {
  for (double& x : v) x = std::fabs(x) < kMinCoordinate ? 0 : x;
  return v;
}

inline bool within_reach(const Vec3& v) noexcept {  // false for what is not a number
  return std::fabs(v[0]) <= kFarthest && std::fabs(v[1]) <= kFarthest && std::fabs(v[2]) <= kFarthest;
}

struct Frame {  // the frame of a body, with coordinates relative to the tree's origin
  Frame(const Vec3& tree_origin, double tree_radius, const Pose& body) noexcept
      : origin(tree_origin), bounding_radius(tree_radius), pose(body), back(inverse(body)) {}
  Frame(const TreeView& tree, const Pose& body) noexcept : Frame(tree.origin, tree.bounding_radius, body) {}
  Vec3 enter(const Vec3& world) const noexcept { return settled(minus(transform(back, world), origin)); }
  Vec3 leave(const Vec3& local) const noexcept { return transform(pose, along(local, origin, 1)); }
  Vec3 origin;
  double bounding_radius;
  const Pose& pose;
  Pose back;
};

// A point or a segment for the tests in float: its ends, a box around it, and the margins for rounding.
struct FloatShape {
  bool in_float = true;  // floats can hold the coordinates; otherwise, the other members mean nothing
  std::array<float, 3> from{}, to{};
  NodeBox box{};
  Placement placement{};
};

inline FloatShape shape_of(const TreeView& tree, const Segment& s) noexcept {
  constexpr double unit = 0x1p-24;
  const Ball all = ball_around(tree);
  const Vec3 middle = along(s.p, s.d, 0.5);
  const double half = length(s.d) / 2;
  const double size = length(middle) + half + length(all.middle) + all.radius;
  FloatShape shape;
  shape.in_float = size <= kFloatReach;
  Vec3 normal = {1, 0, 0};
  if (half > 0) {  // across the segment
    normal = unit_or_zero(cross(along({0, 0, 0}, s.d, 0.5 / half), least_axis(s.d)));
  }
  const auto f = [](double x) { return static_cast<float>(x); };
  const Vec3 second = half > 0 ? along({0, 0, 0}, cross(s.d, normal), 0.5 / half) : Vec3{0, 1, 0};
  const float thin = f(half * 1e-6), reach = f(half * (1 + 1e-6));
  const auto four = [f](const Vec3& v) -> std::array<float, 4> { return {f(v[0]), f(v[1]), f(v[2]), 0}; };
  shape.box = {four(middle), four(normal), four(second), reach, thin, thin, reach};
  const Vec3 end = along(s.p, s.d, 1);
  for (std::size_t i = 0; i < 3; ++i) shape.from[i] = f(s.p[i]), shape.to[i] = f(end[i]);
  Placement& p = shape.placement;
  p.margin = f(std::max(128 * unit * size, 1e-15) * (1 + 4 * unit));
  p.box_margin = f(std::max(256 * unit * size, 1e-15) * (1 + 4 * unit));
  const int exponent = 1 + exponent_of(std::max(size, 1e-18));
  p.unit = f(scaled(1, -exponent)), p.whole = f(scaled(1, exponent));
  return shape;
}

// Returns the lane with the smallest gap, the first one of equals. Precondition: `lanes` has at least one bit.
inline std::uint32_t nearest_lane(const std::array<float, kBlockWidth>& gaps, std::uint32_t lanes) noexcept {
  auto nearest = static_cast<std::uint32_t>(std::countr_zero(lanes));
  for (std::uint32_t rest = lanes & (lanes - 1); rest != 0; rest &= rest - 1) {
    const auto lane = static_cast<std::uint32_t>(std::countr_zero(rest));
    if (gaps[lane] < gaps[nearest]) nearest = lane;
  }
  return nearest;
}

// Calls visit(block, lane, may_meet) for the triangles that may be within limit() of the segment, until it returns
// false. `may_meet` is whether the triangle may meet the segment. The nearest ball slabs of a block and the nearest
// triangles of a leaf come first. Returns a lower bound on the distance of all other triangles from the segment; 0 if
// visit() has returned false.
template <typename Limit, typename Visit>
float walk_outward(const TreeView& tree, const Segment& segment, Limit&& limit, Visit&& visit) noexcept {
  const FloatShape shape = shape_of(tree, segment);
  if (!shape.in_float) {
    for (const TriangleBlock& block : tree.triangle_blocks) {
      for (std::uint32_t left = used_lanes(block); left != 0; left &= left - 1) {
        if (!visit(block, static_cast<std::uint32_t>(std::countr_zero(left)), true)) return 0;
      }
    }
    return 0;
  }
  struct Entry {
    float gap;
    std::uint32_t child;
  };
  std::array<Entry, kWalkRoom> stack;
  std::size_t size = 0;
  BoxGaps gaps;
  std::array<float, kBlockWidth> row;
  float beyond = std::numeric_limits<float>::infinity();
  const auto leave_out = [&](float gap) { beyond = std::min(beyond, gap); };
  stack[size++] = {0, tree.obb_nodes[0].child[0]};
  while (size > 0) {
    const Entry entry = stack[--size];
    if (double{entry.gap} > limit()) {
      leave_out(entry.gap);
      continue;
    }
    if (entry.child & kLeafBit) {
      const TriangleBlock& block = tree.triangle_blocks[entry.child & ~kLeafBit];
      segment_gaps(shape.from, shape.to, block, shape.placement, row);
      const Within some = within(row, limit());
      leave_out(some.beyond);  // lanes without a triangle repeat the first one
      std::uint32_t left = some.lanes & used_lanes(block);
      while (left != 0) {
        const std::uint32_t nearest = nearest_lane(row, left);
        left &= ~(1u << nearest);
        if (double{row[nearest]} > limit()) {
          leave_out(row[nearest]);
          break;
        }
        if (!visit(block, nearest, row[nearest] <= 0)) return 0;
      }
      continue;
    }
    const ObbNodeBlock& block = tree.obb_nodes[entry.child];
    box_gaps(shape.box, block, 1, shape.placement.box_margin, gaps);
    const Within some = within(gaps.gap, limit());
    leave_out(some.beyond);
    size = push_farthest_first(
        stack.data(), size, some.lanes,
        [&](std::uint32_t lane) {
          return Entry{gaps.gap[lane], block.child[lane]};
        },
        [](const Entry& child, std::uint32_t) { return child.gap; });
  }
  return beyond;
}

}  // namespace orchard::runtime::detail
