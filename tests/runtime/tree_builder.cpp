#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "support.h"

// Trees by median splits, with bounds by brute force.
namespace orchard::runtime::test {
namespace {

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Vec& a) { return std::sqrt(dot(a, a)); }
Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

float above(double value) {  // the least float that is not below
  const auto rounded = static_cast<float>(value);
  return rounded < value ? std::nextafter(rounded, std::numeric_limits<float>::infinity()) : rounded;
}

struct Box {
  Vec lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  void add(const Vec& p) {
    for (std::size_t i = 0; i < 3; ++i) lower[i] = std::min(lower[i], p[i]), upper[i] = std::max(upper[i], p[i]);
  }
  std::size_t longest() const {
    const Vec size = minus(upper, lower);
    return static_cast<std::size_t>(std::max_element(size.begin(), size.end()) - size.begin());
  }
};

struct Inner {
  std::size_t block, lane;
  Children children;
};

struct Pending {  // a node whose children are still to be placed
  std::size_t block, lane, begin, end;
  std::uint32_t level;
};

class Builder {
 public:
  Builder(const Mesh& mesh, const TreeOptions& options) : mesh_(mesh), options_(options) {
    for (const Vec& v : mesh.vertices) {
      tree_.vertices.push_back({static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])});
    }
    tree_.triangles = mesh.triangles;
    tree_.origin = options.origin;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) order_.push_back(t);
  }

  PackedSphereTree build() {
    std::vector<Pending> queue;
    tree_.blocks.emplace_back().radius.fill(-1);
    place({0, 0, 0, order_.size(), 0});
    queue.push_back({0, 0, 0, order_.size(), 0});
    for (std::size_t next = 0; next < queue.size(); ++next) expand(Pending(queue[next]), queue);
    for (const Inner& node : inner_) {  // now that the branching is known
      tree_.blocks[node.block].link[node.lane] = inner_link(tree_.branching, node.children);
    }
    tree_.bounding_radius = double(tree_.blocks[0].radius[0]);
    index_triangles(tree_);
    return std::move(tree_);
  }

 private:
  Vec corner(std::uint32_t triangle, std::size_t i) const {
    const auto& v = tree_.vertices[tree_.triangles[triangle][i]];
    return {double(v[0]), double(v[1]), double(v[2])};
  }

  void expand(const Pending& node, std::vector<Pending>& queue) {
    const std::size_t size = node.end - node.begin;
    tree_.depth = std::max(tree_.depth, node.level);
    SiblingBlock& own = tree_.blocks[node.block];
    if (size <= options_.leaf_triangles || node.level >= options_.max_depth) {
      own.link[node.lane] = add_list(tree_, std::span(order_).subspan(node.begin, size));
      return;
    }
    const auto parts = split(node.begin, node.end);
    const auto children = static_cast<std::uint32_t>(parts.size() - 1);
    const std::size_t first = tree_.blocks.size();
    inner_.push_back({node.block, node.lane, {static_cast<std::uint32_t>(first), children}});
    tree_.branching = std::max(tree_.branching, children);
    for (std::uint32_t b = 0; b < block_count(children); ++b) tree_.blocks.emplace_back().radius.fill(-1);
    for (std::uint32_t c = 0; c < children; ++c) {
      const Pending child = {first + c / kBlockWidth, c % kBlockWidth, parts[c], parts[c + 1], node.level + 1};
      place(child);
      queue.push_back(child);
    }
  }

  // Halves the largest part until there are enough; returns where the parts begin, and the end.
  std::vector<std::size_t> split(std::size_t begin, std::size_t end) {
    std::vector<std::size_t> at = {begin, end};
    while (at.size() - 1 < options_.branching) {
      std::size_t widest = 0;
      for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        if (at[i + 1] - at[i] > at[widest + 1] - at[widest]) widest = i;
      }
      const std::size_t from = at[widest], to = at[widest + 1];
      if (to - from < 2) break;
      Box box;
      for (std::size_t i = from; i < to; ++i) box.add(centroid(order_[i]));
      const std::size_t axis = box.longest(), middle = from + (to - from) / 2;
      const auto at_index = [this](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
      std::sort(at_index(from), at_index(to), [this, axis](std::uint32_t a, std::uint32_t b) {
        return std::pair(centroid(a)[axis], a) < std::pair(centroid(b)[axis], b);
      });
      at.insert(at.begin() + static_cast<std::ptrdiff_t>(widest) + 1, middle);
    }
    return at;
  }

  Vec centroid(std::uint32_t t) const {
    Vec c{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) c[i] += corner(t, k)[i] / 3;
    }
    return c;
  }

  void place(const Pending& node) {
    Box box;
    for (std::size_t i = node.begin; i < node.end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) box.add(corner(order_[i], k));
    }
    Vec center{};
    if (node.begin < node.end) {
      for (std::size_t i = 0; i < 3; ++i) center[i] = double(static_cast<float>((box.lower[i] + box.upper[i]) / 2));
    }
    double radius = 0;
    for (std::size_t i = node.begin; i < node.end; ++i) {
      for (std::size_t k = 0; k < 3; ++k) radius = std::max(radius, length(minus(corner(order_[i], k), center)));
    }
    SiblingBlock& block = tree_.blocks[node.block];
    block.x[node.lane] = static_cast<float>(center[0]);
    block.y[node.lane] = static_cast<float>(center[1]);
    block.z[node.lane] = static_cast<float>(center[2]);
    block.radius[node.lane] = above(radius * (1 + 1e-14));
    const double depth = options_.bounds ? signed_distance(center) : std::numeric_limits<double>::infinity();
    block.depth[node.lane] = above(depth + 1e-12 * radius);
    block.error[node.lane] = above(std::max(0.0, double(block.radius[node.lane]) + double(block.depth[node.lane])));
    ++tree_.node_count;
  }

  double signed_distance(const Vec& p) const {
    const std::array<long double, 3> query = {p[0], p[1], p[2]};
    double distance = std::numeric_limits<double>::infinity(), angle = 0;
    for (std::uint32_t t = 0; t < tree_.triangles.size(); ++t) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) triangle[k][i] = corner(t, k)[i];
      }
      distance = std::min(distance, static_cast<double>(point_distance(query, triangle)));
      angle += solid_angle(minus(corner(t, 0), p), minus(corner(t, 1), p), minus(corner(t, 2), p));
    }
    if (tree_.triangles.empty()) return std::numeric_limits<double>::infinity();
    return mesh_.closed && angle > 2 * std::numbers::pi ? -distance : distance;
  }

  static double solid_angle(const Vec& a, const Vec& b, const Vec& c) {
    const double la = length(a), lb = length(b), lc = length(c);
    return 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }

  const Mesh& mesh_;
  TreeOptions options_;
  PackedSphereTree tree_;
  std::vector<std::uint32_t> order_;
  std::vector<Inner> inner_;
};

}  // namespace

PackedSphereTree build_tree(const Mesh& mesh, const TreeOptions& options) { return Builder(mesh, options).build(); }

TriangleBlock one_block(const PackedSphereTree& tree) {
  TriangleBlock block{};
  for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
    const bool used = lane < tree.triangles.size();
    const std::uint32_t number = used ? lane : 0;
    block.triangle[lane] = used ? number : kNoTriangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& corner = tree.vertices[tree.triangles[number][k]];
      for (std::size_t i = 0; i < 3; ++i) block.corner[k][i][lane] = corner[i];
    }
  }
  return block;
}

}  // namespace orchard::runtime::test
