#include "detector/shapes.h"

#include <algorithm>
#include <numeric>

#include "collision/support_box.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {
namespace {

// The least float that is not smaller.
float float_above(double x) noexcept {
  const auto nearest = static_cast<float>(x);
  return double{nearest} < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

// Just above half of the diagonal: twelve triangles between the corners of a box, in one node. The corners are rounded
// outward, so that what does not touch the triangles, or lies at a distance from them, does so of the box.
PackedSphereTree box_tree(const Vec3& half) {
  PackedSphereTree tree;
  std::array<float, 3> rounded{};
  Vec3 beyond{};
  for (unsigned i = 0; i < 3; ++i) {
    rounded[i] = float_above(half[i]);
    beyond[i] = double{rounded[i]} - half[i];
  }
  tree.vertex_error = length(beyond) * (1 + 1e-12);
  for (unsigned corner = 0; corner < 8; ++corner) {
    std::array<float, 3> vertex{};
    for (unsigned i = 0; i < 3; ++i) vertex[i] = corner >> i & 1 ? rounded[i] : -rounded[i];
    tree.vertices.push_back(vertex);
  }
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, w = 1u << axis;
    tree.triangles.push_back({0, v, u}), tree.triangles.push_back({u, v, u + v});
    tree.triangles.push_back({w, w + u, w + v}), tree.triangles.push_back({w + u, w + u + v, w + v});
  }
  double square = 0;
  for (const float x : tree.vertices[7]) square += double{x} * double{x};
  const auto radius = std::nextafter(static_cast<float>(std::sqrt(square) * (1 + 1e-7)), 2e18f);
  tree.bounding_radius = double{radius};
  tree.branching = 1;
  tree.node_count = 1;
  SiblingBlock& block = tree.blocks.emplace_back();
  block.radius.fill(-1);
  block.radius[0] = radius;
  // The solid holds its centre, so no point of the ball is farther from it than the radius.
  block.error[0] = radius;
  block.depth[0] = 0;
  std::array<std::uint32_t, 12> all{};
  std::iota(all.begin(), all.end(), 0u);
  block.link[0] = add_list(tree, all);
  index_triangles(tree);
  return tree;
}

// One vertex of each piece whose triangles share vertices, in the order of vertices.
std::vector<std::uint32_t> pieces_of(const TreeView& tree) {
  std::vector<std::uint32_t> parent(tree.vertices.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<bool> used(parent.size());
  for (const auto& triangle : tree.triangles) {
    for (const std::uint32_t v : triangle) {
      used[v] = true;
      const std::uint32_t p = root(triangle[0]), q = root(v);
      parent[std::max(p, q)] = std::min(p, q);
    }
  }
  std::vector<std::uint32_t> pieces;
  for (std::uint32_t v = 0; v < parent.size(); ++v) {
    if (used[v] && root(v) == v) pieces.push_back(v);
  }
  return pieces;
}

// Precondition: there is room for all of them.
void place_pieces(Shape& shape) noexcept {
  for (std::size_t i = 0; i < shape.pieces.size(); ++i) {
    const auto& at = shape.tree.vertices[shape.piece_vertices[i]];
    for (std::size_t d = 0; d < 3; ++d) shape.pieces[i][d] = double{at[d]} + shape.tree.origin[d];
  }
}

bool is_coordinate(double x) noexcept { return std::fabs(x) <= double{kCoordinateLimit}; }
bool is_point(const Vec3& p) noexcept { return is_coordinate(p[0]) && is_coordinate(p[1]) && is_coordinate(p[2]); }

}  // namespace

ShapeId ShapeTable::add(Shape&& shape) {
  shapes_.push_back(std::move(shape));
  Shape& kept = shapes_.back();
  if (!kept.own.blocks.empty()) kept.tree = kept.own;
  kept.prepared = PreparedTree(kept.tree);
  return static_cast<ShapeId>(shapes_.size() - 1);
}

ShapeId ShapeTable::add_tree(const TreeView& tree) {
  if (structure_fault(tree) != nullptr) return kNoShape;
  Shape shape;
  describe(tree, shape);
  return add(std::move(shape));
}

ShapeId ShapeTable::add_tree(PackedSphereTree&& tree) {
  Shape shape;
  shape.own = std::move(tree);
  describe(shape.own, shape);
  return add(std::move(shape));
}

void ShapeTable::describe(const TreeView& tree, Shape& shape) {
  shape.tree = tree;
  const SiblingBlock& root = tree.blocks[0];
  shape.center = Vec3{double{root.x[0]}, double{root.y[0]}, double{root.z[0]}} + tree.origin;
  // What is stored may be rounded away from the mesh, and the tree's ball holds both.
  shape.reach = double{root.radius[0]} + tree.vertex_error;
  shape.reach += 1e-15 * (shape.reach + length(shape.center));
  const SupportBox box = support_box(tree);
  shape.box_low = box.low, shape.box_high = box.high;
  shape.piece_vertices = pieces_of(tree);
  shape.pieces.resize(shape.piece_vertices.size());
  place_pieces(shape);
}

void ShapeTable::changed(ShapeId shape) noexcept {
  if (!shapes_[shape].piece_vertices.empty()) place_pieces(shapes_[shape]);
}

ShapeId ShapeTable::add_round(const Vec3& p, const Vec3& q, double radius) {
  if (!is_point(p) || !is_point(q) || !(radius >= 0) || !is_coordinate(radius)) return kNoShape;
  Shape shape;
  shape.kind = ShapeKind::round;
  shape.p = p, shape.q = q, shape.radius = radius;
  shape.own = segment_tree(p, q);
  shape.center = 0.5 * (p + q);
  shape.reach = (0.5 * length(q - p) + radius) * (1 + 1e-15) + 1e-15 * (length(p) + length(q));
  return add(std::move(shape));
}

ShapeId ShapeTable::add_box(const Vec3& half_lengths) {
  if (!is_point(half_lengths) || !is_point(2.0 * half_lengths)) return kNoShape;
  for (const double half : half_lengths) {
    if (!(half >= 0)) return kNoShape;
  }
  Shape shape;
  shape.kind = ShapeKind::box;
  shape.own = box_tree(half_lengths);
  shape.p = half_lengths;
  shape.reach = shape.own.bounding_radius;
  for (std::size_t i = 0; i < 3; ++i) shape.box_high[i] = double{shape.own.vertices[7][i]};
  shape.box_low = -1.0 * shape.box_high;
  shape.pieces = {shape.p};
  return add(std::move(shape));
}

double distance_to_bounds(const Shape& shape, const Vec3& point) noexcept {
  if (shape.kind == ShapeKind::round) return length(point - nearest_of_segment(shape.p, shape.q, point)) - shape.radius;
  Vec3 beyond{};
  for (std::size_t i = 0; i < 3; ++i) {
    beyond[i] = std::max({0.0, shape.box_low[i] - point[i], point[i] - shape.box_high[i]});
  }
  return length(beyond);
}

std::size_t ShapeTable::memory_bytes() const noexcept {
  std::size_t bytes = 0;
  for (const Shape& shape : shapes_) bytes += sizeof(Shape) + shape.pieces.capacity() * sizeof(Vec3);
  return bytes;
}

// compose() of poses that are rigid is off by at most twice the tolerance, which made_rigid() mends.
Pose placed(const Pose& body, const Pose& local) noexcept {
  const Pose pose = compose(body, local);
  if (is_rigid(pose) || !is_rigid(body) || !is_rigid(local)) {
    if (is_rigid(body)) return pose;
    Pose nothing;  // two wrongs, mirrors for one, can make a right
    nothing.rotation = {};
    return nothing;
  }
  return made_rigid(pose).value_or(pose);
}

}  // namespace orchard::runtime::detail
