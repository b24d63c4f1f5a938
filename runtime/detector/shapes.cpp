#include "detector/shapes.h"

#include <algorithm>
#include <numeric>

#include "collision/support_box.h"
#include "orchard/runtime/packed_tree.h"

namespace orchard::runtime::detail {
namespace {

// Returns the least float that is not smaller than x.
float float_above(double x) noexcept {
  const auto nearest = static_cast<float>(x);
  return double{nearest} < x ? std::nextafter(nearest, std::numeric_limits<float>::infinity()) : nearest;
}

// Builds the tree of a solid box. Its corners are rounded outward, so the triangles enclose the box: a shape outside of
// them that does not touch them does not touch the box, and its distance from them is a lower bound on that from the
// box.
PackedSphereTree solid_box_tree(const Vec3& half) {
  Vec3 rounded{};
  for (std::size_t i = 0; i < 3; ++i) rounded[i] = double{float_above(half[i])};
  PackedSphereTree tree = box_tree(rounded);
  tree.vertex_error = length(rounded - half) * (1 + 1e-12);
  return tree;
}

// Returns one vertex of each connected piece of the surface, in ascending order. Triangles that share a vertex are
// connected.
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

// Computes the positions of the vertices in piece_vertices. Precondition: shape.pieces has as many elements.
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
  if (kept.kind == ShapeKind::tree) describe(kept);
  return static_cast<ShapeId>(shapes_.size() - 1);
}

ShapeId ShapeTable::add_tree(const TreeView& tree) {
  if (structure_fault(tree) != nullptr) return kNoShape;
  Shape shape;
  shape.tree = tree;
  return add(std::move(shape));
}

ShapeId ShapeTable::add_tree(PackedSphereTree&& tree) {
  Shape shape;
  shape.own = std::move(tree);
  return add(std::move(shape));
}

void ShapeTable::describe(Shape& shape) {
  const TreeView& tree = shape.tree;
  const SiblingBlock& root = tree.blocks[0];
  shape.center = Vec3{double{root.x[0]}, double{root.y[0]}, double{root.z[0]}} + tree.origin;
  // The stored vertices may differ from those of the mesh by rounding. The sphere contains both.
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
  shape.own = solid_box_tree(half_lengths);
  shape.p = half_lengths;
  shape.reach = shape.own.bounding_radius;
  for (std::size_t i = 0; i < 3; ++i) shape.box_high[i] = double{float_above(half_lengths[i])};
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

// compose() of two rigid poses is off by at most twice the tolerance, which made_rigid() corrects.
Pose placed(const Pose& body, const Pose& local) noexcept {
  const Pose pose = compose(body, local);
  if (is_rigid(pose) || !is_rigid(body) || !is_rigid(local)) {
    if (is_rigid(body)) return pose;
    return {.rotation = {}};  // otherwise, two mirrors, which are not rigid, could have a rigid product
  }
  return made_rigid(pose).value_or(pose);
}

}  // namespace orchard::runtime::detail
