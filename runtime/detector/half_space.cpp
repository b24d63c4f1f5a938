#include <algorithm>

#include "collision/outermost_points.h"
#include "detector/simple_pair.h"
#include "math/vector_functions.h"
#include "orchard/runtime/shape_query.h"

// Shapes against half-spaces: the least height of a shape over the plane decides.
namespace orchard::runtime::detail {
namespace {

struct Bottom {
  double height = kInfinity;  // over the plane
  Vec3 point{};
  std::uint32_t triangle = kNoTriangle;
};

Bottom bottom_of(const Shape& shape, const Pose& pose, const HalfSpace& half) noexcept {
  if (shape.kind == ShapeKind::round) {
    const Vec3 p = transform(pose, shape.p), q = transform(pose, shape.q);
    const double at_p = dot(half.normal, p), at_q = dot(half.normal, q), radius = shape.radius * pose.scale;
    const Vec3& lower = at_p <= at_q ? p : q;
    return {std::min(at_p, at_q) - radius - half.offset, lower - radius * half.normal, kNoTriangle};
  }
  const SurfacePoint lowest = deepest_point(shape.tree, pose, half.normal, half.offset);
  return {lowest.distance, lowest.point, lowest.triangle};
}

bool can_ask(const Shape& shape) noexcept { return shape.kind == ShapeKind::round || !shape.tree.obb_nodes.empty(); }

}  // namespace

Verdict test_half_space(const Shape& a, const Pose& pose, const HalfSpace& b) noexcept {
  Verdict verdict;
  verdict.separation_bound = kInfinity;
  if (!can_ask(a)) return verdict;
  const Bottom bottom = bottom_of(a, pose, b);
  if (!std::isfinite(bottom.height)) return verdict;
  verdict.level = 1;
  if (bottom.height > 0) {
    verdict.answer = Answer::no;
    verdict.separation_bound = verdict.lower_bound = bottom.height;
    return verdict;
  }
  verdict.answer = Answer::yes;
  verdict.separation_bound = 0;
  verdict.contact.center = bottom.point;
  verdict.contact.normal = -1.0 * b.normal;
  verdict.contact.triangle_a = bottom.triangle;
  return verdict;
}

namespace {

// How far a ball slab, a ball between two planes, reaches along a unit vector from its centre, at most.
double reach_of(const ObbNodeBlock& block, std::uint32_t lane, const Vec3& n) noexcept {
  const Vec3 normal = {double{block.nx[lane]}, double{block.ny[lane]}, double{block.nz[lane]}};
  const double radius = double{block.radius[lane]}, cosine = std::fabs(dot(n, normal));
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)) + 1e-5;  // the normal is unit to 1e-6
  return std::min(radius, double{block.height[lane]} * cosine * (1 + 1e-5) + radius * sine);
}

// Of a tree's surface what is in the plane n . x + offset = 0, in the tree's frame and relative to its origin.
class PlaneCut {
 public:
  PlaneCut(const TreeView& tree, const Vec3& n, double offset) noexcept
      : tree_(tree), n_(n), offset_(offset), slack_(1e-12 * (tree.bounding_radius + std::fabs(offset))) {}

  // Calls visit(place, triangle) for the ends of the lines in which triangles cut the plane, and for corners in it.
  // `below`: for all corners below it instead.
  template <typename Visit>
  void each_point(bool below, Visit&& visit) const noexcept {
    std::array<std::uint32_t, kBlockWidth*(kTriangleTreeDepthLimit + 1) + 1> stack;
    std::size_t size = 0;
    stack[size++] = tree_.obb_nodes[0].child[0];
    while (size > 0) {
      const std::uint32_t child = stack[--size];
      if ((child & kLeafBit) != 0) {
        visit_leaf(tree_.triangle_blocks[child & ~kLeafBit], below, visit);
        continue;
      }
      const ObbNodeBlock& block = tree_.obb_nodes[child];
      for (std::uint32_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
        const double height = height_of({double{block.x[lane]}, double{block.y[lane]}, double{block.z[lane]}});
        const double reach = reach_of(block, lane, n_) * (1 + 1e-12) + slack_;
        if (height <= reach && (below || height >= -reach)) stack[size++] = block.child[lane];
      }
    }
  }

 private:
  double height_of(const Vec3& p) const noexcept { return dot(n_, p) + offset_; }

  template <typename Visit>
  void visit_leaf(const TriangleBlock& block, bool below, Visit&& visit) const noexcept {
    for (std::uint32_t lane = 0; lane < kBlockWidth && block.triangle[lane] != kNoTriangle; ++lane) {
      std::array<Vec3, 3> corners;
      std::array<double, 3> heights;
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) corners[k][i] = double{block.corner[k][i][lane]};
        heights[k] = height_of(corners[k]);
        if (below ? heights[k] <= 0 : std::fabs(heights[k]) <= slack_) visit(corners[k], block.triangle[lane]);
      }
      for (std::size_t k = 0; k < 3 && !below; ++k) {
        const std::size_t next = (k + 1) % 3;
        const double low = std::min(heights[k], heights[next]), high = std::max(heights[k], heights[next]);
        if (!(low < -slack_ && high > slack_)) continue;
        const double share = heights[k] / (heights[k] - heights[next]);
        visit(corners[k] + share * (corners[next] - corners[k]), block.triangle[lane]);
      }
    }
  }

  const TreeView& tree_;
  Vec3 n_;
  double offset_, slack_;
};

// Two unit vectors across a unit vector and each other.
std::array<Vec3, 2> axes_across(const Vec3& n) noexcept {
  const Vec3 across = cross(n, least_axis(n)), e = (1 / length(across)) * across;
  return {e, cross(n, e)};
}

struct CutPoint {
  Vec3 place{};
  std::uint32_t triangle = kNoTriangle;
};

// How high the lowest corner of the point's triangle is along the normal, or the point itself.
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

// The outermost points of where the surface cuts the plane, seen along its normal; of a body that is wholly below it,
// of all corners.
std::uint32_t cut_points(const Shape& shape, const Pose& pose, const HalfSpace& half,
                         std::array<CutPoint, kMaxContactPoints>& points) noexcept {
  const Vec3 normal = rotate(inverse(Pose{.rotation = pose.rotation}), half.normal), origin = shape.tree.origin;
  const double offset = dot(normal, origin) + (dot(half.normal, Vec3(pose.translation)) - half.offset) / pose.scale;
  const PlaneCut cut(shape.tree, normal, offset);
  bool any = false;
  cut.each_point(false, [&any](const Vec3&, std::uint32_t) { any = true; });
  const std::array<Vec3, 2> across = axes_across(normal);
  const auto each = [&](auto&& visit) {
    cut.each_point(!any, [&](const Vec3& place, std::uint32_t triangle) {
      visit({dot(across[0], place), dot(across[1], place)}, CutPoint{place, triangle});
    });
  };
  const std::uint32_t count = outermost_points(each, points);
  for (std::uint32_t i = 0; i < count; ++i) points[i].place = transform(pose, points[i].place + origin);
  return count;
}

// Below each end of a capsule that is in the half-space; one point of a sphere.
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
  if (!can_ask(a)) return;
  manifold.depth = std::max(0.0, -bottom_of(a, pose, b).height);
  std::array<CutPoint, kMaxContactPoints> points;
  const std::uint32_t count =
      a.kind == ShapeKind::round ? end_points(a, pose, b, points) : cut_points(a, pose, b, points);
  if (count == 0) return;  // by rounding only the verdict's lowest point reaches the plane
  manifold.count = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double deep = b.offset - lowest_of(a, pose, b, points[i]);
    manifold.points[i] = {points[i].place, points[i].triangle, kNoTriangle, std::clamp(deep, 0.0, manifold.depth)};
  }
}

double half_space_distance(const Shape& a, const Pose& pose, const HalfSpace& b) noexcept {
  if (!can_ask(a) || !is_rigid(pose)) return 0;
  const Bottom bottom = bottom_of(a, pose, b);
  const double size = length(bottom.point) + std::fabs(b.offset) + length(Vec3(pose.translation));
  return std::isfinite(bottom.height) ? std::max(0.0, bottom.height - 1e-14 * size) : 0;
}

}  // namespace orchard::runtime::detail
