#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "half_edges.h"
#include "repair_steps.h"

namespace orchard::detail {
namespace {

using Edge = std::pair<Index, Index>;  // lower vertex, higher vertex

Edge edge_between(Index a, Index b) { return std::minmax(a, b); }

// Loops of boundary edges in the direction of the triangles. No loop passes a vertex twice.
class BoundaryLoops {
 public:
  BoundaryLoops(const TriangleMesh& mesh, std::span<const EdgeUse> uses) : place_(mesh.vertices.size(), kNone) {
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 1) return;
      const auto& t = mesh.triangles[edge[0].half_edge / 3];
      const Index i = edge[0].half_edge % 3;
      edges_.emplace_back(t[i], t[(i + 1) % 3]);
    });
    std::sort(edges_.begin(), edges_.end());
    walked_.assign(edges_.size(), false);
    for (std::size_t first = 0; first < edges_.size(); ++first)
      if (!walked_[first]) walk_from(edges_[first].first);
  }
  const std::vector<std::vector<Index>>& loops() const { return loops_; }

 private:
  // A loop is complete where the path meets itself. A path that ends elsewhere bounds no hole.
  void walk_from(Index vertex) {
    path_.assign(1, vertex);
    place_[vertex] = 0;
    for (std::size_t edge = unwalked_from(vertex); edge < edges_.size(); edge = unwalked_from(vertex)) {
      walked_[edge] = true;
      vertex = edges_[edge].second;
      if (place_[vertex] == kNone) {
        place_[vertex] = static_cast<Index>(path_.size());
        path_.push_back(vertex);
        continue;
      }
      const auto start = path_.begin() + place_[vertex];
      if (path_.end() - start >= 3) loops_.emplace_back(start, path_.end());
      for (auto passed = start + 1; passed != path_.end(); ++passed) place_[*passed] = kNone;
      path_.erase(start + 1, path_.end());
    }
    for (const Index passed : path_) place_[passed] = kNone;
  }

  std::size_t unwalked_from(Index vertex) const {
    auto at = std::lower_bound(edges_.begin(), edges_.end(), std::pair{vertex, Index{0}});
    for (; at != edges_.end() && at->first == vertex; ++at)
      if (!walked_[static_cast<std::size_t>(at - edges_.begin())]) return static_cast<std::size_t>(at - edges_.begin());
    return edges_.size();
  }

  std::vector<std::pair<Index, Index>> edges_;  // from, to; sorted
  std::vector<bool> walked_;
  std::vector<Index> path_, place_;  // the position of each vertex on the path
  std::vector<std::vector<Index>> loops_;
};

struct Extent {
  double diameter = 0, width = 0;  // `width` is the largest distance of a point from the diameter
};

constexpr std::size_t kMaxForPairs = 2000;  // up to this number of points, all pairs are compared

// For more points, the diameter is that of their box, which no pair exceeds.
Extent extent(std::span<const Point> points) {
  if (points.size() > kMaxForPairs) {
    Box box;
    for (const Point& point : points) box.extend(point);
    return {box.diagonal().norm(), box.diagonal().norm()};
  }
  std::size_t a = 0, b = 0;
  double squared = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const double between = (points[i] - points[j]).squaredNorm();
      if (between > squared) squared = between, a = i, b = j;
    }
  const Vector axis = (points[b] - points[a]).normalized();
  double width = 0;
  for (const Point& point : points) width = std::max(width, axis.cross(point - points[a]).norm());
  return {std::sqrt(squared), width};
}

class HoleFiller {
 public:
  HoleFiller(TriangleMesh& mesh, const RepairMeshOptions& options, double radius, MeshRepairReport& report)
      : mesh_(mesh), options_(options), report_(report), radius_(radius), uses_(sorted_edge_uses(mesh)) {}

  void run() {
    const BoundaryLoops boundary(mesh_, uses_);
    report_.holes_left = report_.edges_of_hole_left = 0;
    report_.max_hole_left = 0;
    for (const auto& loop : boundary.loops()) fill(loop);
  }

 private:
  void fill(const std::vector<Index>& loop) {
    // The hole of a single triangle is its own back.
    if (loop.size() == 3 && is_triangle(loop)) return;
    std::vector<Point> polyline;
    polyline.reserve(loop.size());
    for (const Index vertex : loop) polyline.push_back(mesh_.vertices[vertex]);
    const auto [diameter, width] = extent(polyline);
    if (loop.size() > options_.max_hole_edges ||
        (diameter > options_.max_hole_diameter * radius_ && width > options_.max_crack_width * radius_))
      return leave(loop.size(), diameter / radius_);
    auto cap = triangles_over(loop, polyline);
    if (cap.empty() || !fits(loop, cap)) cap = fan_over(loop, polyline);
    mesh_.triangles.insert(mesh_.triangles.end(), cap.begin(), cap.end());
    if (width <= options_.join_distance * radius_) {
      ++report_.cracks_closed;
      report_.cracks_triangles += static_cast<Index>(cap.size());
      return;
    }
    ++report_.holes_filled;
    report_.triangles_added += static_cast<Index>(cap.size());
    report_.max_hole = std::max(report_.max_hole, diameter);
  }

  void leave(std::size_t edges, double diameter) {
    ++report_.holes_left;
    if (diameter <= report_.max_hole_left) return;
    report_.max_hole_left = diameter;
    report_.edges_of_hole_left = static_cast<Index>(edges);
  }

  // Reversed so that they run against the loop.
  static std::vector<std::array<Index, 3>> triangles_over(const std::vector<Index>& loop,
                                                          std::span<const Point> polyline) {
    auto triangles = loop.size() == 3 ? std::vector<std::array<Index, 3>>{{0, 2, 1}} : triangulate_polyline(polyline);
    const Index n = static_cast<Index>(loop.size());
    if (triangles.size() != loop.size() - 2) return {};
    bool along = false;
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i) along |= (t[i] + 1) % n == t[(i + 1) % 3];
    for (auto& t : triangles) {
      if (along) std::swap(t[1], t[2]);
      for (Index& corner : t) corner = loop[corner];
    }
    return triangles;
  }

  // Fills the hole with a fan around a new vertex in the middle, which is always possible.
  std::vector<std::array<Index, 3>> fan_over(const std::vector<Index>& loop, std::span<const Point> polyline) {
    Vector middle = Vector::Zero();
    for (const Point& point : polyline) middle += point / static_cast<double>(polyline.size());
    const Index vertex = static_cast<Index>(mesh_.vertices.size());
    mesh_.vertices.push_back(middle);
    std::vector<std::array<Index, 3>> triangles;
    for (std::size_t i = 0; i < loop.size(); ++i) triangles.push_back({loop[(i + 1) % loop.size()], loop[i], vertex});
    return triangles;
  }

  // Whether no edge between two corners of the loop exists already.
  bool fits(const std::vector<Index>& loop, std::span<const std::array<Index, 3>> cap) {
    std::set<Edge> on_loop, inner;
    for (std::size_t i = 0; i < loop.size(); ++i) on_loop.insert(edge_between(loop[i], loop[(i + 1) % loop.size()]));
    for (const auto& t : cap)
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = edge_between(t[i], t[(i + 1) % 3]);
        if (!on_loop.contains(edge)) inner.insert(edge);
      }
    const auto taken = [&](const Edge& edge) { return added_.contains(edge) || exists(edge); };
    if (std::any_of(inner.begin(), inner.end(), taken)) return false;
    added_.insert(inner.begin(), inner.end());
    return true;
  }

  bool exists(const Edge& edge) const {
    const auto before = [](const EdgeUse& use, const Edge& key) { return Edge(use.low, use.high) < key; };
    const auto at = std::lower_bound(uses_.begin(), uses_.end(), edge, before);
    return at != uses_.end() && Edge(at->low, at->high) == edge;
  }

  bool is_triangle(const std::vector<Index>& loop) const {
    const Edge edge = edge_between(loop[0], loop[1]);
    const auto before = [](const EdgeUse& use, const Edge& key) { return Edge(use.low, use.high) < key; };
    const auto at = std::lower_bound(uses_.begin(), uses_.end(), edge, before);
    return std::ranges::count(mesh_.triangles[at->half_edge / 3], loop[2]) > 0;
  }

  TriangleMesh& mesh_;
  const RepairMeshOptions& options_;
  MeshRepairReport& report_;
  double radius_;
  std::vector<EdgeUse> uses_;  // before any hole is filled
  std::set<Edge> added_;
};

}  // namespace

void fill_holes(TriangleMesh& mesh, const RepairMeshOptions& options, double radius, MeshRepairReport& report) {
  HoleFiller(mesh, options, radius, report).run();
}

}  // namespace orchard::detail
