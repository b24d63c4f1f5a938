#include "orchard/spheretree/pack.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "orchard/geometry/error.h"
#include "orchard/spheretree/certify.h"
#include "packed_nodes.h"

namespace orchard {
namespace {

// The limit on coordinates of meshes leaves room: balls of a tree are not hundreds of times as large as the mesh.
static_assert(500 * kMaxCoordinate <= double{runtime::kCoordinateLimit});

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

// The least float that is not below `value`.
float round_up(double value) {
  const auto rounded = static_cast<float>(value);
  return static_cast<double>(rounded) < value ? std::nextafter(rounded, kFloatInfinity) : rounded;
}

// A bound on the rounding errors of a difference and a norm in doubles, for lengths up to `size`.
double slack(double size) { return 0x1p-48 * size; }

class Packer {
 public:
  // `surface`: nullptr for a tree over balls alone.
  Packer(const SphereTree& tree, const Surface* surface) : tree_(tree), surface_(surface) {
    if (tree.nodes.empty()) throw Error("pack: the tree has no root");
    origin_ = bounds().center;
  }

  runtime::PackedSphereTree run() {
    for (int axis = 0; axis < 3; ++axis) packed_.origin[static_cast<std::size_t>(axis)] = origin_[axis];
    packed_.bounding_radius = bounds().radius;
    packed_.branching = tree_.branching;
    packed_.depth = tree_.depth();
    packed_.node_count = static_cast<std::uint32_t>(tree_.nodes.size());
    pack_nodes();
    if (surface_ != nullptr) {
      pack_mesh();
      list_triangles();
      runtime::index_triangles(packed_);
    }
    return std::move(packed_);
  }

 private:
  struct Place {
    std::uint32_t block, lane;
  };

  const Sphere& bounds() const { return surface_ != nullptr ? surface_->bounding_ball() : tree_.nodes.front().sphere; }

  // Nodes are in breadth-first order, so blocks come out in that order too.
  void pack_nodes() {
    places_.resize(tree_.nodes.size());
    places_[0] = {0, 0};
    packed_.blocks.resize(1);
    packed_.blocks[0].radius.fill(-1);
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      const SphereNode& node = tree_.nodes[i];
      pack_node(node, places_[i]);
      set_link(places_[i], runtime::kEmptyLeaf);
      if (node.child_count == 0) continue;
      const auto block = static_cast<std::uint32_t>(packed_.blocks.size());
      if (block > runtime::last_linked_block(tree_.branching)) throw Error("pack: the tree is too large to be packed");
      set_link(places_[i], runtime::inner_link(tree_.branching, {block, node.child_count}));
      packed_.blocks.resize(block + (node.child_count + runtime::kBlockWidth - 1) / runtime::kBlockWidth);
      for (std::uint32_t b = block; b < packed_.blocks.size(); ++b) packed_.blocks[b].radius.fill(-1);
      for (std::uint32_t child = 0; child < node.child_count; ++child)
        places_[node.first_child + child] = {block + child / runtime::kBlockWidth, child % runtime::kBlockWidth};
    }
  }

  void pack_node(const SphereNode& node, Place at) {
    runtime::SiblingBlock& block = packed_.blocks[at.block];
    const Vector exact = node.sphere.center - origin_;
    if (!(exact.cwiseAbs().maxCoeff() + node.sphere.radius < double{runtime::kCoordinateLimit} / 2))
      throw Error("pack: a ball lies beyond the largest coordinate that a packed tree may have; scale the mesh down");
    const Eigen::Vector3f rounded = exact.cast<float>();
    // A bound on the distance of the packed centre from the true one: it includes the rounding to float, the roundings
    // of the difference below, and those of adding the origin, by which users return to the mesh's frame.
    const double moved = (exact - rounded.cast<double>()).norm() * (1 + 0x1p-48) +
                         slack(exact.norm() + node.sphere.radius + origin_.norm());
    block.x[at.lane] = rounded.x();
    block.y[at.lane] = rounded.y();
    block.z[at.lane] = rounded.z();
    block.radius[at.lane] = round_up(node.sphere.radius + moved);
    const double grown = block.radius[at.lane] - node.sphere.radius + moved;
    block.depth[at.lane] = round_up(node.center_distance + moved + slack(std::abs(node.center_distance)));
    block.error[at.lane] = round_up(std::max(0.0, node.distance_bound) + grown);
  }

  void set_link(Place at, std::uint32_t link) { packed_.blocks[at.block].link[at.lane] = link; }

  void pack_mesh() {
    const TriangleMesh& mesh = surface_->mesh();
    double farthest = 0;
    for (const Point& vertex : mesh.vertices) {
      const Vector exact = vertex - origin_;
      const Eigen::Vector3f rounded = exact.cast<float>();
      farthest = std::max(farthest, (exact - rounded.cast<double>()).norm() + slack(exact.norm()));
      packed_.vertices.push_back({rounded.x(), rounded.y(), rounded.z()});
    }
    packed_.vertex_error = farthest;
    packed_.triangles.assign(mesh.triangles.begin(), mesh.triangles.end());
  }

  // A leaf lists the triangles that touch every ball on its path: all that its path region meets, and few more.
  void list_triangles() {
    std::vector<std::vector<Index>> touching(tree_.nodes.size());
    std::vector<Index> near;
    for (std::size_t i = 0; i < tree_.nodes.size(); ++i) {
      const SphereNode& node = tree_.nodes[i];
      surface_->triangles_near(packed_ball(places_[i]), near);
      if (i == 0) {
        touching[0] = near;
      } else {
        const auto& above = touching[node.parent];
        std::set_intersection(above.begin(), above.end(), near.begin(), near.end(), std::back_inserter(touching[i]));
      }
      if (i > 0 && i + 1 == last_child(node.parent) + 1) touching[node.parent] = {};
      if (node.child_count > 0) continue;
      set_link(places_[i], runtime::add_list(packed_, touching[i]));
    }
  }

  std::size_t last_child(Index parent) const {
    return tree_.nodes[parent].first_child + tree_.nodes[parent].child_count - 1;
  }

  Sphere packed_ball(Place at) const {
    const runtime::SiblingBlock& block = packed_.blocks[at.block];
    const Point center = origin_ + Vector(block.x[at.lane], block.y[at.lane], block.z[at.lane]);
    const double radius = block.radius[at.lane];
    return {center, radius + slack(radius + center.norm())};
  }

  const SphereTree& tree_;
  const Surface* surface_;
  Point origin_;
  std::vector<Place> places_;
  runtime::PackedSphereTree packed_;
};

}  // namespace

runtime::PackedSphereTree pack(const SphereTree& tree, const Surface& surface) { return Packer(tree, &surface).run(); }

runtime::PackedSphereTree pack(const SphereTree& tree) { return Packer(tree, nullptr).run(); }

SphereTree unpack(const runtime::PackedSphereTree& packed) {
  const Point origin(packed.origin[0], packed.origin[1], packed.origin[2]);
  const std::vector<PackedNode> places = packed_nodes(packed);
  const std::vector<PathBall> balls = path_balls(packed);
  SphereTree tree;
  tree.branching = packed.branching;
  for (Index i = 0; i < balls.size(); ++i) {
    const runtime::SiblingBlock& block = packed.blocks[places[i].block];
    SphereNode node{.sphere = {balls[i].center + origin, balls[i].radius}, .parent = balls[i].parent};
    node.center_distance = block.depth[places[i].lane];
    node.distance_bound = block.error[places[i].lane];
    if (node.parent != kNone) {
      SphereNode& parent = tree.nodes[node.parent];
      node.level = parent.level + 1;
      if (parent.child_count++ == 0) parent.first_child = i;
    }
    tree.nodes.push_back(node);
  }
  return tree;
}

}  // namespace orchard
