#include <algorithm>

#include "collision/kernels/triangle_block.h"
#include "collision/outermost_points.h"
#include "collision/triangle_cut.h"
#include "detector/simple_pair.h"
#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

// Tests of shapes against half-spaces. The least height of the shape over the plane decides.
namespace orchard::runtime::detail {

SurfacePoint lowest_point(const Shape& shape, const Pose& pose, const HalfSpace& half) noexcept {
  if (shape.has_tree()) return deepest_point(shape.tree, pose, half.normal, half.offset);
  const Vec3 p = transform(pose, shape.p), q = transform(pose, shape.q);
  const double at_p = dot(half.normal, p), at_q = dot(half.normal, q), radius = shape.radius * pose.scale;
  const Vec3& lower = at_p <= at_q ? p : q;
  return {std::min(at_p, at_q) - radius - half.offset, lower - radius * half.normal, kNoTriangle};
}

namespace {

// Calls visit(place, triangle) for the points at which the surface of a tree meets the plane n . x + offset = 0: the
// ends of the lines in which triangles cut it, and corners of triangles in it. The plane is in the tree's frame,
// relative to the tree's origin. If `below` is set, the points are all corners in the plane or below it instead.
template <typename Visit>
void each_cut_point(const TreeView& tree, const Vec3& n, double offset, bool below, Visit&& visit) noexcept {
  const double slack = 1e-12 * (tree.bounding_radius + std::fabs(offset));
  const auto visit_triangle = [&](const TrianglePoints& corners, std::uint32_t triangle) {
    std::array<double, 3> heights;
    for (std::size_t k = 0; k < 3; ++k) {
      heights[k] = dot(n, corners[k]) + offset;
      if (below ? heights[k] <= 0 : std::fabs(heights[k]) <= slack) visit(corners[k], triangle);
    }
    for (std::size_t k = 0; k < 3 && !below; ++k) {
      const std::size_t next = (k + 1) % 3;
      const double low = std::min(heights[k], heights[next]), high = std::max(heights[k], heights[next]);
      if (!(low < -slack && high > slack)) continue;
      const double share = heights[k] / (heights[k] - heights[next]);
      visit(corners[k] + share * (corners[next] - corners[k]), triangle);
    }
  };
  std::array<std::uint32_t, std::size_t{kBlockWidth} * (kTriangleTreeDepthLimit + 1) + 1> stack;
  std::size_t size = 0;
  stack[size++] = tree.obb_nodes[0].child[0];
  while (size > 0) {
    const std::uint32_t child = stack[--size];
    if ((child & kLeafBit) != 0) {
      const TriangleBlock& block = tree.triangle_blocks[child & ~kLeafBit];
      for (std::uint32_t lane = 0; lane < kBlockWidth && block.triangle[lane] != kNoTriangle; ++lane)
        visit_triangle(points_of(block, lane), block.triangle[lane]);
      continue;
    }
    const ObbNodeBlock& block = tree.obb_nodes[child];
    for (std::uint32_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
      const double height = dot(n, Vec3{block.x[lane], block.y[lane], block.z[lane]}) + offset;
      const double reach = reach_along(block, lane, n) * (1 + 1e-12) + slack;
      if (height <= reach && (below || height >= -reach)) stack[size++] = block.child[lane];
    }
  }
}

struct CutPoint {
  Vec3 place{};
  std::uint32_t triangle = kNoTriangle;
};

// Returns the height, along the normal, of the lowest corner of the point's triangle; if it has none, that of the
// point.
double lowest_of(const Shape& shape, const Pose& pose, const HalfSpace& half, const CutPoint& point) noexcept {
  if (point.triangle == kNoTriangle) return dot(half.normal, point.place);
  double low = std::numeric_limits<double>::infinity();
  for (const std::uint32_t v : shape.tree.triangles[point.triangle]) {
    const auto& corner = shape.tree.vertices[v];
    const Vec3 place = {double{corner[0]}, double{corner[1]}, double{corner[2]}};
    low = std::min(low, dot(half.normal, transform(pose, place + Vec3(shape.tree.origin))));
  }
  return low;
}

// Finds the outermost points, seen along the normal, of those at which the surface cuts the plane. If there are none,
// the body is wholly below the plane, and these are the outermost of all its corners.
std::uint32_t cut_points(const Shape& shape, const Pose& pose, const HalfSpace& half,
                         std::array<CutPoint, kMaxContactPoints>& points) noexcept {
  const Vec3 normal = rotate(inverse(Pose{.rotation = pose.rotation}), half.normal), origin = shape.tree.origin;
  const double offset = dot(normal, origin) + (dot(half.normal, Vec3(pose.translation)) - half.offset) / pose.scale;
  bool any = false;
  each_cut_point(shape.tree, normal, offset, false, [&any](const Vec3&, std::uint32_t) { any = true; });
  const Way way(normal);
  const auto each = [&](auto&& visit) {
    each_cut_point(shape.tree, normal, offset, !any, [&](const Vec3& place, std::uint32_t triangle) {
      visit({dot(way.e, place), dot(way.f, place)}, CutPoint{place, triangle});
    });
  };
  const std::uint32_t count = outermost_points(each, points);
  for (std::uint32_t i = 0; i < count; ++i) points[i].place = transform(pose, points[i].place + origin);
  return count;
}

// Finds the lowest point of the sphere around each end of a capsule, if it is in the half-space; for a sphere, one
// point.
std::uint32_t end_points(const Shape& shape, const Pose& pose, const HalfSpace& half,
                         std::array<CutPoint, kMaxContactPoints>& points) noexcept {
  const double radius = shape.radius * pose.scale;
  std::uint32_t count = 0;
  for (const Vec3& end : {shape.p, shape.q}) {
    const Vec3 place = transform(pose, end) - radius * half.normal;
    if (dot(half.normal, place) <= half.offset && (count == 0 || shape.q != shape.p)) points[count++].place = place;
  }
  return count;
}

}  // namespace

void half_space_contact(const Shape& a, const Pose& pose, const HalfSpace& b, Manifold& manifold) noexcept {
  manifold.depth = std::max(0.0, -lowest_point(a, pose, b).distance);
  std::array<CutPoint, kMaxContactPoints> points;
  const std::uint32_t count =
      a.kind == ShapeKind::round ? end_points(a, pose, b, points) : cut_points(a, pose, b, points);
  if (count == 0) return;  // because of rounding, only the lowest point of the verdict reaches the plane
  manifold.count = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double deep = b.offset - lowest_of(a, pose, b, points[i]);
    manifold.points[i] = {points[i].place, points[i].triangle, kNoTriangle, std::clamp(deep, 0.0, manifold.depth)};
  }
}

double half_space_distance(const Shape& a, const Pose& pose, const HalfSpace& b) noexcept {
  if (!is_rigid(pose)) return 0;
  const SurfacePoint lowest = lowest_point(a, pose, b);
  const double size = length(Vec3(lowest.point)) + std::fabs(b.offset) + length(Vec3(pose.translation));
  return std::isfinite(lowest.distance) ? std::max(0.0, lowest.distance - 1e-14 * size) : 0;
}

}  // namespace orchard::runtime::detail
