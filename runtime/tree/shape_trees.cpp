#include "orchard/runtime/packed_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "math/exact_sign.h"
#include "math/vector_functions.h"
#include "tree/box_facets.h"

namespace orchard::runtime {

using detail::cross;
using detail::minus;
using detail::orientation;
using detail::stored_above;

namespace {

using Point = std::array<double, 3>;
using HullTriangle = std::array<std::uint32_t, 3>;

// Sets the bounds of the root. `depth` is an upper bound on the signed distance of its centre.
void set_depth(PackedSphereTree& tree, double depth) {
  tree.blocks[0].depth[0] = stored_above(depth);
  tree.blocks[0].error[0] = stored_above(tree.bounding_radius + std::max(0.0, depth));
}

// Returns a tree with one sphere around everything, which is a leaf.
PackedSphereTree tree_of(std::span<const Point> vertices, std::span<const HullTriangle> triangles, double depth) {
  PackedSphereTree tree;
  if (vertices.empty()) return tree;
  Point low = vertices[0], high = vertices[0];
  for (const Point& v : vertices) {
    for (std::size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], v[i]), high[i] = std::max(high[i], v[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) tree.origin[i] = low[i] + (high[i] - low[i]) / 2;
  for (const Point& v : vertices) {
    std::array<float, 3> stored{};
    const Vec3 exact = minus(v, tree.origin);
    for (std::size_t i = 0; i < 3; ++i) stored[i] = static_cast<float>(exact[i]);
    tree.vertices.push_back(stored);
    const Vec3 rounded(stored[0], stored[1], stored[2]);
    tree.vertex_error = std::max(tree.vertex_error, length(rounded - exact) * (1 + 1e-12));
    tree.bounding_radius = std::max(tree.bounding_radius, length(rounded));
  }
  tree.bounding_radius += tree.vertex_error;
  tree.triangles.assign(triangles.begin(), triangles.end());
  tree.branching = 1;
  tree.node_count = 1;
  SiblingBlock& root = tree.blocks.emplace_back();
  root.radius.fill(-1);
  root.radius[0] = stored_above(tree.bounding_radius);
  set_depth(tree, depth);
  std::vector<std::uint32_t> all(triangles.size());
  for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
  root.link[0] = add_list(tree, all);
  index_triangles(tree);
  return tree;
}

// Computes a convex hull by adding one point after the other. The facets that a point sees are replaced by triangles
// between the point and their outline. Points in the plane of a facet do not see it, so no facet is ever without area.
class Hull {
 public:
  explicit Hull(std::span<const Point> points) : points_(points) {}

  bool build() {
    if (!start()) return false;
    for (std::uint32_t p = 0; p < points_.size(); ++p) add(p);
    return true;
  }
  const std::vector<HullTriangle>& triangles() const { return triangles_; }

 private:
  int side(const HullTriangle& t, std::uint32_t p) const {  // > 0: outside
    return -orientation(points_[t[0]], points_[t[1]], points_[t[2]], points_[p]);
  }

  bool start() {
    const auto count = static_cast<std::uint32_t>(points_.size());
    if (count < 4) return false;
    std::uint32_t b = 1, c = 1, d = 1;
    while (b < count && points_[b] == points_[0]) ++b;
    if (b == count) return false;
    while (c < count && detail::in_line(points_[0], points_[b], points_[c])) ++c;
    if (c == count) return false;
    while (d < count && orientation(points_[0], points_[b], points_[c], points_[d]) == 0) ++d;
    if (d == count) return false;
    const HullTriangle base = {0, b, c};
    const bool outward = side(base, d) < 0;
    const std::uint32_t x = outward ? b : c, y = outward ? c : b;
    triangles_ = {{0, x, y}, {0, y, d}, {y, x, d}, {x, 0, d}};
    return true;
  }

  void add(std::uint32_t p) {
    std::vector<HullTriangle> kept, seen;
    for (const HullTriangle& t : triangles_) (side(t, p) > 0 ? seen : kept).push_back(t);
    if (seen.empty()) return;
    for (const HullTriangle& t : seen) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t from = t[i], to = t[(i + 1) % 3];
        const bool inner = std::any_of(seen.begin(), seen.end(), [&](const HullTriangle& other) {
          return (other[0] == to && other[1] == from) || (other[1] == to && other[2] == from) ||
                 (other[2] == to && other[0] == from);
        });
        if (!inner) kept.push_back({from, to, p});
      }
    }
    triangles_.swap(kept);
  }

  std::span<const Point> points_;
  std::vector<HullTriangle> triangles_;
};

}  // namespace

PackedSphereTree point_tree(const Point& point) {
  const Point vertices[] = {point};
  const HullTriangle triangles[] = {{0, 0, 0}};
  return tree_of(vertices, triangles, 0);
}

PackedSphereTree segment_tree(const Point& p, const Point& q) {
  const Point vertices[] = {p, q};
  const HullTriangle triangles[] = {{0, 1, 1}};
  return tree_of(vertices, triangles, 0);
}

PackedSphereTree box_tree(const Point& half) { return tree_of(detail::box_corners(half), detail::kBoxFacets, 0); }

PackedSphereTree triangles_tree(std::span<const Point> vertices,
                                std::span<const std::array<std::uint32_t, 3>> triangles) {
  return tree_of(vertices, triangles, std::numeric_limits<double>::infinity());
}

std::optional<PackedSphereTree> hull_tree(std::span<const Point> points) {
  for (const Point& p : points) {
    for (const double x : p) {
      if (!(std::fabs(x) <= double{kCoordinateLimit})) return std::nullopt;
    }
  }
  Hull hull(points);
  if (!hull.build()) return std::nullopt;
  std::vector<std::uint32_t> place(points.size(), kNoTriangle);
  std::vector<Point> corners;
  std::vector<HullTriangle> triangles = hull.triangles();
  for (HullTriangle& t : triangles) {
    for (std::uint32_t& v : t) {
      if (place[v] == kNoTriangle) place[v] = static_cast<std::uint32_t>(corners.size()), corners.push_back(points[v]);
      v = place[v];
    }
  }
  // The middle of the hull's bounding box may be outside of the hull, but it is no farther from the hull than from its
  // corners.
  PackedSphereTree tree = tree_of(corners, triangles, 0);
  double depth = -std::numeric_limits<double>::infinity();
  for (const HullTriangle& t : triangles) {
    const Point n = cross(minus(corners[t[1]], corners[t[0]]), minus(corners[t[2]], corners[t[0]]));
    const double size = std::sqrt(dot(n, n));
    if (size > 0) depth = std::max(depth, dot(n, minus(tree.origin, corners[t[0]])) / size);
  }
  if (depth > -1e-9 * tree.bounding_radius) set_depth(tree, tree.bounding_radius);
  return tree;
}

}  // namespace orchard::runtime
