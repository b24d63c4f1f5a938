#include "orchard/runtime/flexible_tree.h"

#include <algorithm>
#include <cmath>

#include "tree/tree_nodes.h"

namespace orchard::runtime {
namespace {

constexpr float kMaxFloat = std::numeric_limits<float>::max();

float above(double value) noexcept {  // at least `value`, rounding of a few operations in double included
  return value > 0 ? std::nextafter(static_cast<float>(value * (1 + 1e-14)), kMaxFloat) : static_cast<float>(value);
}

float raised(float value, double by) noexcept {  // infinity stays
  return by > 0 && std::isfinite(value) ? std::nextafter(static_cast<float>(double{value} + by), kMaxFloat) : value;
}

double distance_of(const std::array<float, 3>& p, const std::array<float, 3>& q) noexcept {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) square += (double{p[i]} - double{q[i]}) * (double{p[i]} - double{q[i]});
  return std::sqrt(square) * (1 + 1e-15);
}

}  // namespace

FlexibleTree::FlexibleTree(const PackedSphereTree& rest, double max_displacement)
    : tree_(rest), largest_(max_displacement), rest_(rest.vertices) {
  link_spheres();
  link_obb_nodes();
  list_triangles();
  valid_ = largest_ >= 0 && coordinate_extent(tree_) + 4 * largest_ <= double{kCoordinateLimit};
  if (valid_) enlarge_for_good();
}

void FlexibleTree::adopt(std::vector<Node>& nodes, std::uint32_t parent, std::uint32_t child) noexcept {
  nodes[child].used = true;
  nodes[child].parent = parent;
  nodes[child].level = nodes[parent].level + 1;
}

FlexibleTree::Levels FlexibleTree::room_by_level(const std::vector<Node>& nodes) {
  std::vector<std::size_t> counts;
  for (const Node& node : nodes) {
    if (!node.used) continue;
    if (node.level >= counts.size()) counts.resize(node.level + 1);
    ++counts[node.level];
  }
  Levels levels(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) levels[i].reserve(counts[i]);
  return levels;
}

void FlexibleTree::link_spheres() {
  spheres_.resize(tree_.blocks.size() * kBlockWidth);
  spheres_[0].used = true;
  for (std::uint32_t node = 0; node < spheres_.size(); ++node) {  // children come after their parents
    if (!spheres_[node].used) continue;
    const std::uint32_t link = tree_.blocks[node / kBlockWidth].link[node % kBlockWidth];
    spheres_[node].radius = tree_.blocks[node / kBlockWidth].radius[node % kBlockWidth];
    if (link & kLeafBit) {
      rest_radii_ += double{spheres_[node].radius};
      continue;
    }
    const Children children = children_of(tree_.branching, link);
    for (std::uint32_t i = 0; i < children.count; ++i) adopt(spheres_, node, children.first * kBlockWidth + i);
  }
  dirty_.spheres = room_by_level(spheres_);
}

void FlexibleTree::link_obb_nodes() {
  obb_nodes_.resize(tree_.obb_nodes.size() * kBlockWidth);
  slab_of_block_.assign(tree_.triangle_blocks.size(), kNone);
  if (obb_nodes_.empty()) return;
  obb_nodes_[0].used = true;
  for (std::uint32_t node = 0; node < obb_nodes_.size(); ++node) {
    if (!obb_nodes_[node].used) continue;
    const ObbNodeBlock& block = tree_.obb_nodes[node / kBlockWidth];
    const std::uint32_t lane = node % kBlockWidth, child = block.child[lane];
    obb_nodes_[node].radius = block.radius[lane];
    obb_nodes_[node].sides = {block.height[lane], block.width[lane], block.length[lane]};
    if (child & kLeafBit) {
      slab_of_block_[child & ~kLeafBit] = node;
      continue;
    }
    for (std::uint32_t i = 0; i < kBlockWidth && tree_.obb_nodes[child].radius[i] >= 0; ++i)
      adopt(obb_nodes_, node, child * kBlockWidth + i);
  }
  dirty_.slabs = room_by_level(obb_nodes_);
}

// Which triangles each vertex has, and which leaves and blocks each triangle is in.
void FlexibleTree::list_triangles() {
  const auto lists = [](std::size_t count, auto&& for_each) {
    Lists made;
    made.begin.assign(count + 1, 0);
    for_each([&](std::uint32_t key, std::uint32_t) { ++made.begin[key + 1]; });
    for (std::size_t i = 0; i < count; ++i) made.begin[i + 1] += made.begin[i];
    made.items.resize(made.begin[count]);
    std::vector<std::uint32_t> next(made.begin.begin(), made.begin.end() - 1);
    for_each([&](std::uint32_t key, std::uint32_t item) { made.items[next[key]++] = item; });
    return made;
  };
  triangles_of_vertex_ = lists(tree_.vertices.size(), [this](auto&& add) {
    for (std::uint32_t t = 0; t < tree_.triangles.size(); ++t) {
      for (const std::uint32_t v : tree_.triangles[t]) add(v, t);
    }
  });
  leaves_of_triangle_ = lists(tree_.triangles.size(), [this](auto&& add) {
    for (std::uint32_t node = 0; node < spheres_.size(); ++node) {
      if (!spheres_[node].used) continue;
      const std::uint32_t link = tree_.blocks[node / kBlockWidth].link[node % kBlockWidth];
      if ((link & kLeafBit) == 0) continue;
      for (const std::uint32_t entry : listed_triangles(tree_, link)) add(entry & ~kLeafBit, node);
    }
  });
  block_of_triangle_.assign(tree_.triangles.size(), kNone);
  for (std::uint32_t b = 0; b < tree_.triangle_blocks.size(); ++b) {
    for (const std::uint32_t t : tree_.triangle_blocks[b].triangle) {
      if (t != kNoTriangle) block_of_triangle_[t] = b;
    }
  }
  moved_.assign(tree_.triangles.size(), 0);
  dirty_.is_dirty.assign(tree_.triangle_blocks.size(), 0);
  dirty_.blocks.reserve(dirty_.is_dirty.size());
}

// What every query reads of the whole tree, and may keep: it holds for all that the tree can become.
void FlexibleTree::enlarge_for_good() {
  const auto root_center = detail::center_of(tree_, 0);
  const auto from_root = [&](const auto& p) {
    const std::array<double, 3> d = {p[0] - root_center[0], p[1] - root_center[1], p[2] - root_center[2]};
    return length(d);
  };
  double reach = 0;
  for (std::uint32_t node = 0; node < spheres_.size(); ++node) {
    if (!spheres_[node].used) continue;
    reach = std::max(reach, from_root(detail::center_of(tree_, node)) + double{spheres_[node].radius});
  }
  for (const auto& v : tree_.vertices) {
    reach = std::max(reach, from_root(std::array<double, 3>{double{v[0]}, double{v[1]}, double{v[2]}}));
  }
  const float before = spheres_[0].radius;
  const float root_radius = above(std::max(double{before}, reach) + largest_);
  // The nearest point of the solid may have moved away by the largest displacement, and the ball may have grown by it.
  for (std::uint32_t node = 0; node < spheres_.size(); ++node) {
    if (!spheres_[node].used) continue;
    SiblingBlock& block = tree_.blocks[node / kBlockWidth];
    const std::uint32_t lane = node % kBlockWidth;
    block.error[lane] = raised(block.error[lane], 2 * largest_);
    block.depth[lane] = raised(block.depth[lane], largest_);
  }
  tree_.blocks[0].radius[0] = root_radius;
  tree_.blocks[0].error[0] = raised(tree_.blocks[0].error[0], double{root_radius} - double{before});
  for (std::uint32_t i = 0; i < tree_.supports.size(); ++i) {
    tree_.supports[i] = raised(tree_.supports[i], largest_ * length(support_direction(i)));
  }
  tree_.bounding_radius += largest_;
  if (largest_ > 0) tree_.vertex_error += 0x1p-23 * coordinate_extent(tree_);  // places are rounded to float
}

void FlexibleTree::mark(std::vector<Node>& nodes, Levels& levels, std::uint32_t node) noexcept {
  if (nodes[node].dirty) return;
  nodes[node].dirty = true;
  levels[nodes[node].level].push_back(node);
  ++touched_;
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
    if (vertices[i] >= rest_.size()) return false;
    if (!(distance_of(stored(places[i]), rest_[vertices[i]]) <= largest_)) return false;
  }
  touched_ = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) tree_.vertices[vertices[i]] = stored(places[i]);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    for (const std::uint32_t t : triangles_of_vertex_.of(vertices[i])) {
      moved_[t] = 0;
      for (const std::uint32_t v : tree_.triangles[t]) {
        moved_[t] = std::max(moved_[t], distance_of(tree_.vertices[v], rest_[v]));
      }
      for (const std::uint32_t leaf : leaves_of_triangle_.of(t)) mark(spheres_, dirty_.spheres, leaf);
      const std::uint32_t block = block_of_triangle_[t];
      if (block == kNone || dirty_.is_dirty[block]) continue;
      dirty_.is_dirty[block] = 1;
      dirty_.blocks.push_back(block);
    }
  }
  for (const std::uint32_t block : dirty_.blocks) {
    dirty_.is_dirty[block] = 0;
    rewrite(block);
    if (slab_of_block_[block] != kNone) mark(obb_nodes_, dirty_.slabs, slab_of_block_[block]);
  }
  dirty_.blocks.clear();
  refit_spheres();
  refit_obb_nodes();
  return true;
}

void FlexibleTree::rewrite(std::uint32_t index) noexcept {
  TriangleBlock& block = tree_.triangle_blocks[index];
  for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
    const std::uint32_t t = block.triangle[lane] != kNoTriangle ? block.triangle[lane] : block.triangle[0];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const auto& vertex = tree_.vertices[tree_.triangles[t][corner]];
      for (std::size_t i = 0; i < 3; ++i) block.corner[corner][i][lane] = vertex[i];
    }
  }
}

double FlexibleTree::max_of_leaf(std::uint32_t link) const noexcept {
  double largest = 0;
  for (const std::uint32_t entry : listed_triangles(tree_, link)) {
    largest = std::max(largest, moved_[entry & ~kLeafBit]);
  }
  return largest;
}

double FlexibleTree::max_of_block(std::uint32_t index) const noexcept {
  double largest = 0;
  for (const std::uint32_t t : tree_.triangle_blocks[index].triangle) {
    if (t != kNoTriangle) largest = std::max(largest, moved_[t]);
  }
  return largest;
}

// From the lowest level up: by how much each dirty node is enlarged, and its parent then, if that has changed.
template <typename EnlargedBy, typename Write>
void FlexibleTree::refit(std::vector<Node>& nodes, Levels& dirty, const EnlargedBy& enlarged_by,
                         const Write& write) noexcept {
  for (std::size_t level = dirty.size(); level-- > 0;) {
    for (const std::uint32_t index : dirty[level]) {
      Node& node = nodes[index];
      node.dirty = false;
      const double before = std::exchange(node.enlarged, enlarged_by(index));
      write(index, before);
      if (node.enlarged != before && node.parent != kNone) mark(nodes, dirty, node.parent);
    }
    dirty[level].clear();
  }
}

void FlexibleTree::refit_spheres() noexcept {
  const auto link_of = [this](std::uint32_t index) {
    return tree_.blocks[index / kBlockWidth].link[index % kBlockWidth];
  };
  const auto enlarged_by = [&](std::uint32_t index) {
    if (link_of(index) & kLeafBit) return max_of_leaf(link_of(index));
    const Children children = children_of(tree_.branching, link_of(index));
    double enlarged = 0;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      enlarged = std::max(enlarged, spheres_[children.first * kBlockWidth + i].enlarged);
    }
    return enlarged;
  };
  refit(spheres_, dirty_.spheres, enlarged_by, [&](std::uint32_t index, double before) {
    const Node& node = spheres_[index];
    if (link_of(index) & kLeafBit) enlarged_ += node.enlarged - before;
    if (index != 0) tree_.blocks[index / kBlockWidth].radius[index % kBlockWidth] = raised(node.radius, node.enlarged);
  });
}

void FlexibleTree::refit_obb_nodes() noexcept {
  constexpr double kNormalLength = 1 + 2e-6;  // of a ball slab's normals, at most
  const auto enlarged_by = [this](std::uint32_t index) {
    const std::uint32_t child = tree_.obb_nodes[index / kBlockWidth].child[index % kBlockWidth];
    if (child & kLeafBit) return max_of_block(child & ~kLeafBit);
    double enlarged = 0;
    for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
      enlarged = std::max(enlarged, obb_nodes_[child * kBlockWidth + i].enlarged);
    }
    return enlarged;
  };
  refit(obb_nodes_, dirty_.slabs, enlarged_by, [this](std::uint32_t index, double) {
    const Node& node = obb_nodes_[index];
    ObbNodeBlock& block = tree_.obb_nodes[index / kBlockWidth];
    const std::uint32_t lane = index % kBlockWidth;
    block.radius[lane] = raised(node.radius, node.enlarged);
    block.height[lane] = raised(node.sides[0], node.enlarged * kNormalLength);
    block.width[lane] = raised(node.sides[1], node.enlarged * kNormalLength);
    block.length[lane] = raised(node.sides[2], node.enlarged * kNormalLength);
  });
}

}  // namespace orchard::runtime
