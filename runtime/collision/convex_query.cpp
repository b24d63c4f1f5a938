#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/tree_walk.h"
#include "orchard/runtime/shape_query.h"
#include "tree/box_facets.h"

// Queries about half-spaces and convex solids against one tree.
namespace orchard::runtime {

using namespace detail;

namespace {

// A convex solid in a body's frame.
class Solid {
 public:
  // Returns false if the shape is not valid, or so far away that no query can answer.
  bool place(const Frame& frame, const ConvexShape& shape, const Pose& pose) noexcept {
    if (shape.corners.empty() || shape.corners.size() > kMaxCorners || shape.facets.size() > kMaxFacets) return false;
    corners_ = shape.corners.size(), facets_ = shape.facets.size();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    low_ = {infinity, infinity, infinity}, high_ = {-infinity, -infinity, -infinity};
    for (std::size_t i = 0; i < corners_; ++i) {
      corner_[i] = frame.enter(transform(pose, shape.corners[i]));
      if (!within_reach(corner_[i])) return false;
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k] = std::min(low_[k], corner_[i][k]), high_[k] = std::max(high_[k], corner_[i][k]);
      }
    }
    for (std::size_t f = 0; f < facets_; ++f) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (shape.facets[f][k] >= corners_) return false;
        facet_[f][k] = corner_[shape.facets[f][k]];
      }
      if (in_line(facet_[f][0], facet_[f][1], facet_[f][2])) return false;
    }
    return true;
  }

  Vec3 middle() const noexcept { return along(low_, minus(high_, low_), 0.5); }
  double radius() const noexcept {
    double square = 0;
    const Vec3 from = middle();
    for (std::size_t i = 0; i < corners_; ++i) {
      const Vec3 d = minus(corner_[i], from);
      square = std::max(square, dot(d, d));
    }
    return std::sqrt(square);
  }

  bool touches(const TrianglePoints& t) const noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::max({t[0][k], t[1][k], t[2][k]}) < low_[k] || high_[k] < std::min({t[0][k], t[1][k], t[2][k]})) {
        return false;
      }
    }
    bool inside = true;  // whether the triangle's first corner is inside
    for (std::size_t f = 0; f < facets_; ++f) {
      const int first = outside(f, t[0]);
      inside = inside && first <= 0;
      if (first > 0 && outside(f, t[1]) > 0 && outside(f, t[2]) > 0) return false;
    }
    if (inside && facets_ > 0) return true;
    // Some of the triangle is outside of the solid, so it meets the solid only if it meets the surface.
    return std::any_of(facet_.begin(), facet_.begin() + static_cast<std::ptrdiff_t>(facets_),
                       [&t](const TrianglePoints& facet) { return triangles_intersect(facet, t, nullptr); });
  }

 private:
  int outside(std::size_t f, const Vec3& p) const noexcept {
    return -orientation(facet_[f][0], facet_[f][1], facet_[f][2], p);
  }

  std::size_t corners_ = 0, facets_ = 0;
  Vec3 low_{}, high_{};
  std::array<Vec3, kMaxCorners> corner_;
  std::array<TrianglePoints, kMaxFacets> facet_;
};

}  // namespace

SurfacePoint deepest_point(const TreeView& tree, const Pose& pose, const std::array<double, 3>& normal,
                           double offset) noexcept {
  SurfacePoint best;
  if (tree.obb_nodes.empty()) return best;
  const SurfacePoint unknown{-std::numeric_limits<double>::infinity(), {}, kNoTriangle};
  const ScaledVector scaled(normal);
  const double size = length(scaled.value), height_of_plane = std::ldexp(offset, scaled.power);
  if (!is_rigid(pose) || !(size > 0) || !std::isfinite(offset)) return unknown;
  const Frame frame(tree, pose);
  Pose turn = frame.back;
  turn.translation = {};
  const Vec3 n = rotate(turn, along({0, 0, 0}, scaled.value, 1 / size));
  struct Entry {
    double lower;
    std::uint32_t child;
  };
  std::array<Entry, kWalkRoom> stack;
  std::size_t count = 0;
  double least = std::numeric_limits<double>::infinity();
  Vec3 deepest{};
  const Ball all = ball_around(tree);
  const double rounding = kRounding * (length(all.middle) + all.radius);
  stack[count++] = {-std::numeric_limits<double>::infinity(), tree.obb_nodes[0].child[0]};
  while (count > 0) {
    const Entry entry = stack[--count];
    if (entry.lower > least) continue;
    if (entry.child & kLeafBit) {
      each_triangle(tree.triangle_blocks.subspan(entry.child & ~kLeafBit, 1),
                    [&](const TrianglePoints& t, std::uint32_t triangle) {
                      for (const Vec3& p : t) {
                        const double height = dot(n, p);
                        if (height > least || (height == least && triangle >= best.triangle)) continue;
                        least = height, deepest = p, best.triangle = triangle;
                      }
                      return true;
                    });
      continue;
    }
    const ObbNodeBlock& block = tree.obb_nodes[entry.child];
    const std::size_t begin = count;
    for (std::uint32_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
      const Vec3 center = {block.x[lane], block.y[lane], block.z[lane]};
      const double lower = dot(n, center) - reach_along(block, lane, n) - rounding;
      if (lower > least) continue;
      std::size_t at = count++;
      for (; at > begin && stack[at - 1].lower < lower; --at) stack[at] = stack[at - 1];
      stack[at] = {lower, block.child[lane]};
    }
  }
  best.point = frame.leave(deepest);
  best.distance = (dot(scaled.value, best.point) - height_of_plane) / size;
  return best;
}

ShapeContact touches_convex(const TreeView& tree, const Pose& pose, const ConvexShape& shape,
                            const Pose& shape_pose) noexcept {
  ShapeContact result;
  if (!is_rigid(pose) || !is_rigid(shape_pose)) return result;
  const Frame frame(tree, pose);
  Solid solid;
  if (!solid.place(frame, shape, shape_pose)) return result;
  result.answer = Answer::no;
  if (tree.obb_nodes.empty()) return result;
  const Vec3 middle = solid.middle();
  walk_outward(
      tree, Segment(middle, middle), [reach = solid.radius() * (1 + kRounding)] { return reach; },
      [&](const TriangleBlock& block, std::uint32_t lane, bool) {
        if (!solid.touches(points_of(block, lane))) return true;
        result = {Answer::yes, block.triangle[lane]};
        return false;
      });
  return result;
}

ShapeContact touches_box(const TreeView& tree, const Pose& pose, const std::array<double, 3>& half,
                         const Pose& box_pose) noexcept {
  if (!(half[0] > 0 && half[1] > 0 && half[2] > 0)) return {};
  const auto corners = box_corners(half);
  return touches_convex(tree, pose, {corners, kBoxFacets}, box_pose);
}

}  // namespace orchard::runtime
