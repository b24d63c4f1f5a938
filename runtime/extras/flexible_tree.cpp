#include "orchard/runtime/flexible_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/vector_functions.h"
#include "tree/tree_nodes.h"

namespace orchard::runtime {
namespace {

constexpr float kMaxFloat = std::numeric_limits<float>::max();

// Returns at least `value` + `by`, including the rounding of a few operations in double. Infinity stays infinity.
float raised(float value, double by) noexcept {
  return by > 0 && std::isfinite(value) ? std::nextafter(static_cast<float>(double{value} + by), kMaxFloat) : value;
}

double distance_of(const std::array<float, 3>& p, const std::array<float, 3>& q) noexcept {
  return length(Vec3(p[0], p[1], p[2]) - Vec3(q[0], q[1], q[2])) * (1 + 1e-15);
}

// Calls visit(block, lane) for every node, the last one first: children come after their parents.
template <typename Blocks, typename Visit>
void each_node_from_the_leaves(const Blocks& blocks, const Visit& visit) {
  for (std::size_t b = blocks.size(); b-- > 0;) {
    for (std::uint32_t lane = 0; lane < kBlockWidth && blocks[b].radius[lane] >= 0; ++lane) visit(b, lane);
  }
}

}  // namespace

FlexibleTree::FlexibleTree(const PackedSphereTree& rest, double max_displacement)
    : tree_(rest),
      rest_(rest),
      largest_(max_displacement),
      moved_(rest.vertices.size()),
      changed_(rest.vertices.size()),
      spheres_growth_(rest.blocks.size() * kBlockWidth),
      obb_nodes_growth_(rest.obb_nodes.size() * kBlockWidth) {
  valid_ = largest_ >= 0 && coordinate_extent(tree_) + 4 * largest_ <= double{kCoordinateLimit};
  if (valid_) enlarge_permanently();
}

// Enlarges what queries read of the whole tree and may keep, so that it holds for every shape that the tree can take.
void FlexibleTree::enlarge_permanently() {
  const Vec3 root_center = detail::center_of(tree_, 0);
  const float root_before = tree_.blocks[0].radius[0];
  double reach = double{root_before};
  each_node_from_the_leaves(tree_.blocks, [&](std::size_t b, std::uint32_t lane) {
    SiblingBlock& block = tree_.blocks[b];
    const Vec3 center(block.x[lane], block.y[lane], block.z[lane]);
    reach = std::max(reach, length(center - root_center) + double{block.radius[lane]});
    // The nearest point of the solid may have moved away by the largest displacement, and the ball have grown by it.
    block.error[lane] = raised(block.error[lane], 2 * largest_);
    block.depth[lane] = raised(block.depth[lane], largest_);
  });
  for (const auto& v : tree_.vertices) reach = std::max(reach, length(Vec3(v[0], v[1], v[2]) - root_center));
  tree_.blocks[0].radius[0] = detail::stored_above(reach + largest_);
  tree_.blocks[0].error[0] = raised(tree_.blocks[0].error[0], double{tree_.blocks[0].radius[0]} - double{root_before});
  for (std::uint32_t i = 0; i < tree_.supports.size(); ++i) {
    tree_.supports[i] = raised(tree_.supports[i], largest_ * length(support_direction(i)));
  }
  tree_.bounding_radius += largest_;
  if (largest_ > 0) tree_.vertex_error += 0x1p-23 * coordinate_extent(tree_);  // places are rounded to float
}

bool FlexibleTree::move(std::span<const std::uint32_t> vertices,
                        std::span<const std::array<double, 3>> places) noexcept {
  if (!valid_ || places.size() < vertices.size()) return false;
  const auto stored = [this](const std::array<double, 3>& place) {
    std::array<float, 3> result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = static_cast<float>(place[i] - tree_.origin[i]);
    return result;
  };
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i] >= moved_.size()) return false;
    if (!(distance_of(stored(places[i]), rest_.vertices[vertices[i]]) <= largest_)) return false;
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t v = vertices[i];
    tree_.vertices[v] = stored(places[i]);
    moved_[v] = distance_of(tree_.vertices[v], rest_.vertices[v]);
    changed_[v] = 1;
  }
  for (TriangleBlock& block : tree_.triangle_blocks) copy_changed_corners(block);
  for (const std::uint32_t v : vertices) changed_[v] = 0;
  refit_obb_nodes();
  refit_spheres();
  return true;
}

void FlexibleTree::copy_changed_corners(TriangleBlock& block) const noexcept {
  for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
    const std::uint32_t triangle = block.triangle[lane] != kNoTriangle ? block.triangle[lane] : block.triangle[0];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t v = tree_.triangles[triangle][corner];
      if (changed_[v] == 0) continue;
      for (std::size_t i = 0; i < 3; ++i) block.corner[corner][i][lane] = tree_.vertices[v][i];
    }
  }
}

double FlexibleTree::growth_of(std::uint32_t triangle) const noexcept {
  const auto& [p, q, r] = tree_.triangles[triangle];
  return std::max({moved_[p], moved_[q], moved_[r]});
}

void FlexibleTree::refit_obb_nodes() noexcept {
  constexpr double kNormalLength = 1 + 2e-6;  // of a ball slab's normals, at most
  each_node_from_the_leaves(tree_.obb_nodes, [this](std::size_t b, std::uint32_t lane) {
    ObbNodeBlock& block = tree_.obb_nodes[b];
    const std::uint32_t child = block.child[lane];
    double growth = 0;
    for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
      if ((child & kLeafBit) == 0) {
        growth = std::max(growth, obb_nodes_growth_[child * kBlockWidth + i]);
      } else if (const std::uint32_t t = tree_.triangle_blocks[child & ~kLeafBit].triangle[i]; t != kNoTriangle) {
        growth = std::max(growth, growth_of(t));
      }
    }
    if (std::exchange(obb_nodes_growth_[b * kBlockWidth + lane], growth) == growth) return;
    const ObbNodeBlock& rest = rest_.obb_nodes[b];
    block.radius[lane] = raised(rest.radius[lane], growth);
    block.height[lane] = raised(rest.height[lane], growth * kNormalLength);
    block.width[lane] = raised(rest.width[lane], growth * kNormalLength);
    block.length[lane] = raised(rest.length[lane], growth * kNormalLength);
  });
}

void FlexibleTree::refit_spheres() noexcept {
  each_node_from_the_leaves(tree_.blocks, [this](std::size_t b, std::uint32_t lane) {
    const std::uint32_t link = tree_.blocks[b].link[lane];
    double growth = 0;
    if (link & kLeafBit) {
      for (const std::uint32_t entry : listed_triangles(tree_, link)) {
        growth = std::max(growth, growth_of(entry & ~kLeafBit));
      }
    } else {
      const Children children = children_of(tree_.branching, link);
      const auto first = spheres_growth_.begin() + static_cast<std::ptrdiff_t>(children.first) * kBlockWidth;
      growth = *std::max_element(first, first + children.count);
    }
    if (std::exchange(spheres_growth_[b * kBlockWidth + lane], growth) == growth || b == 0) return;
    tree_.blocks[b].radius[lane] = raised(rest_.blocks[b].radius[lane], growth);
  });
}

double FlexibleTree::looseness() const noexcept {
  double grown = 0, radii = 0;
  each_node_from_the_leaves(rest_.blocks, [&](std::size_t b, std::uint32_t lane) {
    if ((rest_.blocks[b].link[lane] & kLeafBit) == 0) return;
    grown += spheres_growth_[b * kBlockWidth + lane];
    radii += double{rest_.blocks[b].radius[lane]};
  });
  return radii > 0 ? grown / radii : 0;
}

}  // namespace orchard::runtime
