#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/tolerance.h"
#include "repair_steps.h"

namespace orchard::detail {
namespace {

// A grid of cubes of any number, which stores only what is occupied.
class SparseGrid {
 public:
  // Cubes are twice as wide as `distance`, so that rounding cannot put two points that near more than one cube apart.
  SparseGrid(std::span<const Point> points, double distance) : width_(2 * distance) {
    Box box;
    for (const Point& point : points) box.extend(point);
    if (!points.empty()) origin_ = box.min();
    entries_.reserve(points.size());
    for (Index i = 0; i < points.size(); ++i) entries_.emplace_back(cell_of(points[i]), i);
    std::sort(entries_.begin(), entries_.end());
  }
  // Of the points in the cube of this place and those around it, which are among them all that are within the distance.
  template <class Visit>
  void visit_near(const Point& place, const Visit& visit) const {
    const Cell center = cell_of(place);
    for (std::int64_t x = center[0] - 1; x <= center[0] + 1; ++x)
      for (std::int64_t y = center[1] - 1; y <= center[1] + 1; ++y) {
        auto at = std::lower_bound(entries_.begin(), entries_.end(), Entry({x, y, center[2] - 1}, 0));
        for (; at != entries_.end() && at->first <= Cell{x, y, center[2] + 1}; ++at) visit(at->second);
      }
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  using Entry = std::pair<Cell, Index>;
  Cell cell_of(const Point& p) const {
    const Vector v = (p - origin_) / width_;
    const auto floored = [](double x) { return static_cast<std::int64_t>(std::floor(x)); };
    return {floored(v.x()), floored(v.y()), floored(v.z())};
  }
  double width_;
  Point origin_ = Point::Zero();
  std::vector<Entry> entries_;
};

// Two edges, or vertices, that may be one.
struct Match {
  double distance;
  Index a, b;
  friend bool operator<(const Match& x, const Match& y) {
    return std::tie(x.distance, x.a, x.b) < std::tie(y.distance, y.a, y.b);
  }
};

// Joins what lies nearest first: where that closes the surface, nothing is open any more that could be joined to what
// lies farther, such as the other side of a thin wall.
class CornerJoiner {
 public:
  CornerJoiner(const TriangleMesh& mesh, double distance, double radius)
      : mesh_(mesh), distance_(distance), rounding_(tolerance::kRounding * radius), sets_(mesh.vertices.size()) {
    const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      if (edge.size() != 1) return;
      const auto& corners = mesh.triangles[edge[0].half_edge / 3];
      const Index i = edge[0].half_edge % 3;
      open_.push_back({corners[i], corners[(i + 1) % 3]});
    });
  }

  void run() {
    // Edges first: where two run along each other, both their ends belong together. What is left are the ends of
    // edges that are divided in different places.
    for (bool joined = true; joined;) joined = join_nearest(edge_matches(), &CornerJoiner::unite_edges);
    for (bool joined = true; joined;) joined = join_nearest(vertex_matches(), &CornerJoiner::unite);
  }
  // The vertex that each one is joined to, perhaps itself.
  Index joined(Index vertex) { return sets_.root(vertex); }

 private:
  using Edge = std::array<Index, 2>;  // from, to, as its one triangle runs

  const Point& place(Index vertex) const { return mesh_.vertices[vertex]; }
  double between(Index a, Index b) const { return (place(a) - place(b)).norm(); }

  // How far the ends of two edges are apart at most: of edges against each other or, of triangles that are turned
  // against each other, along each other.
  double between(const Edge& e, const Edge& f) const {
    return std::min(std::max(between(e[0], f[1]), between(e[1], f[0])),
                    std::max(between(e[0], f[0]), between(e[1], f[1])));
  }

  // For each open edge the nearest other one within the distance.
  std::vector<Match> edge_matches() const {
    std::vector<Point> middles;
    for (const Edge& edge : open_) middles.push_back(place(edge[0]) / 2 + place(edge[1]) / 2);
    return nearest(middles, [&](Index e, Index f) { return between(open_[e], open_[f]); });
  }

  // For each end of an open edge the nearest other one within the distance; names vertices.
  std::vector<Match> vertex_matches() const {
    std::vector<Index> ends;
    for (const Edge& edge : open_) ends.insert(ends.end(), edge.begin(), edge.end());
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<Point> places;
    places.reserve(ends.size());
    for (const Index end : ends) places.push_back(place(end));
    std::vector<Match> matches = nearest(places, [&](Index a, Index b) { return between(ends[a], ends[b]); });
    for (Match& match : matches) match.a = ends[match.a], match.b = ends[match.b];
    return matches;
  }

  template <class Distance>
  std::vector<Match> nearest(std::span<const Point> places, const Distance& distance) const {
    const SparseGrid grid(places, std::max(distance_, rounding_));  // whose cubes can be counted
    std::vector<Match> matches;
    for (Index i = 0; i < places.size(); ++i) {
      Match best{std::numeric_limits<double>::infinity(), 0, 0};
      grid.visit_near(places[i], [&](Index other) {
        if (other == i) return;
        const double apart = distance(i, other);
        if (apart <= distance_) best = std::min(best, Match{apart, std::min(i, other), std::max(i, other)});
      });
      if (best.distance <= distance_) matches.push_back(best);
    }
    std::sort(matches.begin(), matches.end());
    return matches;
  }

  // Joins the nearest of these, and those that are not much farther apart. Returns whether there were any: then others
  // are nearest.
  bool join_nearest(const std::vector<Match>& matches, bool (CornerJoiner::*unite_both)(Index, Index)) {
    constexpr double kNotMuchFarther = 8;
    std::vector<bool> done(std::max(open_.size(), mesh_.vertices.size()), false);
    double up_to = -1;
    for (const Match& match : matches) {
      if (up_to >= 0 && match.distance > up_to) break;
      if (done[match.a] || done[match.b] || !(this->*unite_both)(match.a, match.b)) continue;
      done[match.a] = done[match.b] = true;
      if (up_to < 0) up_to = std::max(rounding_, kNotMuchFarther * match.distance);
    }
    if (up_to < 0) return false;
    update_open();
    return true;
  }

  bool unite_edges(Index e, Index f) {
    const Edge &a = open_[e], &b = open_[f];
    const bool against =
        std::max(between(a[0], b[1]), between(a[1], b[0])) <= std::max(between(a[0], b[0]), between(a[1], b[1]));
    const bool first = unite(a[0], b[against ? 1 : 0]), second = unite(a[1], b[against ? 0 : 1]);
    return first || second;
  }

  // Not if a vertex would move farther than the distance, as those of a chain could. Returns whether that joined what
  // was apart.
  bool unite(Index a, Index b) {
    a = sets_.root(a), b = sets_.root(b);
    if (a == b) return false;
    const Index kept = std::min(a, b), moved = std::max(a, b);
    const std::vector<Index> more = members_.contains(moved) ? members_[moved] : std::vector<Index>{moved};
    if (std::ranges::any_of(more, [&](Index vertex) { return between(vertex, kept) > distance_; })) return false;
    sets_.unite(a, b);
    auto& members = members_.try_emplace(kept, std::vector<Index>{kept}).first->second;
    members.insert(members.end(), more.begin(), more.end());
    members_.erase(moved);
    return true;
  }

  // Edges between the same vertices close each other, two by two; an edge whose ends are joined is gone.
  void update_open() {
    for (Edge& edge : open_) edge = {sets_.root(edge[0]), sets_.root(edge[1])};
    std::erase_if(open_, [](const Edge& edge) { return edge[0] == edge[1]; });
    const auto undirected = [](const Edge& edge) { return std::minmax(edge[0], edge[1]); };
    std::stable_sort(open_.begin(), open_.end(), [&](const Edge& e, const Edge& f) {
      return std::pair<Index, Index>(undirected(e)) < std::pair<Index, Index>(undirected(f));
    });
    std::vector<Edge> left;
    for (std::size_t first = 0, last = 0; first < open_.size(); first = last) {
      std::array<std::size_t, 2> count{};  // in either direction
      for (; last < open_.size() && undirected(open_[last]) == undirected(open_[first]); ++last)
        ++count[open_[last][0] < open_[last][1] ? 0 : 1];
      if ((count[0] + count[1]) % 2 == 0) continue;
      const auto [low, high] = undirected(open_[first]);
      left.push_back(count[0] > count[1] ? Edge{low, high} : Edge{high, low});
    }
    open_ = std::move(left);
  }

  const TriangleMesh& mesh_;
  double distance_, rounding_;
  DisjointSets sets_;
  std::map<Index, std::vector<Index>> members_;  // of each set of several vertices, by its lowest one
  std::vector<Edge> open_;
};

}  // namespace

void join_vertices(TriangleMesh& mesh, double distance, double radius, MeshRepairReport& report) {
  if (!(distance > 0)) return;
  CornerJoiner joiner(mesh, distance, radius);
  joiner.run();
  std::vector<Index> joined(mesh.vertices.size());
  for (Index v = 0; v < joined.size(); ++v) {
    joined[v] = joiner.joined(v);
    if (joined[v] == v) continue;
    ++report.vertices_joined;
    report.max_join = std::max(report.max_join, (mesh.vertices[v] - mesh.vertices[joined[v]]).norm());
  }
  if (report.vertices_joined == 0) return;
  for (auto& corners : mesh.triangles)
    for (Index& vertex : corners) vertex = joined[vertex];
}

}  // namespace orchard::detail
