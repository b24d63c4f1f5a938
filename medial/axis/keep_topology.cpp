#include "keep_topology.h"

#include <algorithm>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>

#include "solid_parts.h"

namespace orchard::detail {
namespace {

// A mesh in more pieces than this is not a solid that a few bridges could repair.
constexpr int kMaxBridges = 1000;

struct Counts {
  std::int64_t components = 0, euler_characteristic = 0;
};

bool all_inside(std::span<const Index> corners, const std::vector<std::uint8_t>& inside) {
  return std::all_of(corners.begin(), corners.end(), [&](Index corner) { return inside[corner] != 0; });
}

Counts count(const VoronoiDiagram& diagram, const VoronoiFaces& faces, const std::vector<std::uint8_t>& inside) {
  Counts counts;
  std::vector<std::uint8_t> reached(inside.size(), 0);
  std::vector<Index> open;
  for (Index start = 0; start < inside.size(); ++start) {
    if (!inside[start]) continue;
    ++counts.euler_characteristic;
    for (const Index next : diagram.vertices[start].neighbors) {
      if (next != kNone && next > start && inside[next]) --counts.euler_characteristic;
    }
    if (reached[start]) continue;
    ++counts.components;
    reached[start] = 1;
    open.push_back(start);
    while (!open.empty()) {
      const Index vertex = open.back();
      open.pop_back();
      for (const Index next : diagram.vertices[vertex].neighbors) {
        if (next == kNone || !inside[next] || reached[next]) continue;
        reached[next] = 1;
        open.push_back(next);
      }
    }
  }
  for (Index face = 0; face < faces.vertices.size(); ++face) {
    if (all_inside(faces.vertices[face], inside)) ++counts.euler_characteristic;
  }
  return counts;
}

class Growth {
 public:
  Growth(const VoronoiDiagram& diagram, const VoronoiFaces& faces, const std::vector<std::uint8_t>& allowed)
      : diagram_(diagram), faces_(faces), allowed_(allowed), taken_(allowed.size(), 0) {
    missing_.reserve(faces.vertices.size());
    std::vector<std::array<Index, 2>> incidences;
    for (Index face = 0; face < faces.vertices.size(); ++face) {
      missing_.push_back(static_cast<Index>(faces.vertices[face].size()));
      if (!all_inside(faces.vertices[face], allowed)) continue;  // such a face can never be completed
      for (const Index vertex : faces.vertices[face]) incidences.push_back({vertex, face});
    }
    std::sort(incidences.begin(), incidences.end());
    auto incidence = incidences.begin();
    for (Index vertex = 0; vertex < allowed.size(); ++vertex) {
      for (; incidence != incidences.end() && (*incidence)[0] == vertex; ++incidence) {
        faces_of_.items.push_back((*incidence)[1]);
      }
      faces_of_.close_row();
    }
  }

  void grow_from(const std::vector<Index>& seeds) {
    for (const Index seed : seeds) take(seed);
    while (!queue_.empty()) {
      const Index vertex = queue_.top().second;
      queue_.pop();
      if (!taken_[vertex] && glued_to_a_tree(vertex)) take(vertex);
    }
  }
  const std::vector<std::uint8_t>& taken() const { return taken_; }

 private:
  // Adds a vertex, and puts every vertex that shares a face or an edge with it back into the queue.
  void take(Index vertex) {
    taken_[vertex] = 1;
    const auto ask = [&](Index other) {
      if (!taken_[other] && allowed_[other]) queue_.emplace(diagram_.vertices[other].radius, other);
    };
    for (const Index next : diagram_.vertices[vertex].neighbors) {
      if (next != kNone) ask(next);
    }
    for (const Index face : faces_of_[vertex]) {
      // When one corner is missing, that vertex completes the face, so only its priority rises.
      if (--missing_[face] != 1) continue;
      for (const Index corner : faces_.vertices[face]) ask(corner);
    }
  }

  bool glued_to_a_tree(Index vertex) const {
    const auto& neighbors = diagram_.vertices[vertex].neighbors;
    std::array<int, 4> set{0, 1, 2, 3};
    int nodes = 0, arcs = 0, joins = 0;
    const auto slot = [&](Index other) {
      return static_cast<std::size_t>(std::find(neighbors.begin(), neighbors.end(), other) - neighbors.begin());
    };
    for (const Index next : neighbors) nodes += next != kNone && taken_[next] ? 1 : 0;
    for (const Index face : faces_of_[vertex]) {
      if (missing_[face] != 1) continue;
      const auto corners = faces_.vertices[face];
      const auto at = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), vertex) - corners.begin());
      const std::size_t before = slot(corners[(at + corners.size() - 1) % corners.size()]);
      const std::size_t after = slot(corners[(at + 1) % corners.size()]);
      if (before == 4 || after == 4) return false;
      ++arcs;
      const int from = set[before], to = set[after];
      if (from == to) continue;
      ++joins;
      std::replace(set.begin(), set.end(), from, to);
    }
    return nodes > 0 && arcs == joins && joins == nodes - 1;
  }

  const VoronoiDiagram& diagram_;
  const VoronoiFaces& faces_;
  const std::vector<std::uint8_t>& allowed_;
  std::vector<std::uint8_t> taken_;
  std::vector<Index> missing_;  // of each face: corners not taken
  Rows faces_of_;               // the faces of each vertex that can still be completed
  std::priority_queue<std::pair<double, Index>> queue_;
};

// Returns, for each part of the surface, the largest ball inside whose forming points are all on this part. Parts
// without such a ball have none.
std::vector<Index> max_balls(const SurfaceSampling& sampling, const SolidParts& parts, const VoronoiDiagram& diagram,
                             const std::vector<std::uint8_t>& inside) {
  std::vector<Index> max(parts.count(), kNone);
  for (Index i = 0; i < inside.size(); ++i) {
    if (!inside[i]) continue;
    const VoronoiVertex& vertex = diagram.vertices[i];
    const auto part_of = [&](Index point) { return parts.of_triangle[sampling.triangles[point]]; };
    const Index part = part_of(vertex.forming_points[0]);
    const bool all = std::all_of(vertex.forming_points.begin(), vertex.forming_points.end(),
                                 [&](Index point) { return part_of(point) == part; });
    if (!all) continue;
    if (max[part] == kNone || vertex.radius > diagram.vertices[max[part]].radius) max[part] = i;
  }
  std::erase(max, kNone);
  return max;
}

// Extends `kept` along single edges within `allowed`, the largest balls first. `stems` receives the edge of each vertex
// that is added.
void join_by_stems(const VoronoiDiagram& diagram, const std::vector<std::uint8_t>& allowed,
                   std::vector<std::uint8_t>& kept, std::vector<Index>& stems) {
  std::priority_queue<std::tuple<double, Index, Index>> queue;  // radius, vertex, stem
  const auto offer_neighbors = [&](Index vertex) {
    for (const Index next : diagram.vertices[vertex].neighbors) {
      if (next != kNone && allowed[next] && !kept[next]) queue.emplace(diagram.vertices[next].radius, next, vertex);
    }
  };
  for (Index vertex = 0; vertex < kept.size(); ++vertex) {
    if (kept[vertex]) offer_neighbors(vertex);
  }
  while (!queue.empty()) {
    const auto [radius, vertex, stem] = queue.top();
    queue.pop();
    if (kept[vertex]) continue;
    kept[vertex] = 1;
    stems[vertex] = stem;
    offer_neighbors(vertex);
  }
}

// Returns the ends of the shortest path along edges of the diagram from the kept vertices to other allowed ones; kNone
// if there is no path.
std::array<Index, 2> shortest_bridge(const VoronoiDiagram& diagram, const std::vector<std::uint8_t>& allowed,
                                     const std::vector<std::uint8_t>& kept) {
  using Step = std::tuple<double, Index, Index>;  // length, vertex, start of the path
  std::priority_queue<Step, std::vector<Step>, std::greater<>> queue;
  std::vector<std::uint8_t> reached = kept;
  const auto leave = [&](Index vertex, Index start, double length) {
    for (const Index next : diagram.vertices[vertex].neighbors) {
      if (next == kNone || reached[next] || diagram.vertices[next].at_infinity()) continue;
      queue.emplace(length + (diagram.vertices[next].center - diagram.vertices[vertex].center).norm(), next, start);
    }
  };
  for (Index vertex = 0; vertex < kept.size(); ++vertex) {
    if (kept[vertex]) leave(vertex, vertex, 0);
  }
  while (!queue.empty()) {
    const auto [length, vertex, start] = queue.top();
    queue.pop();
    if (reached[vertex]) continue;
    if (allowed[vertex]) return {vertex, start};
    reached[vertex] = 1;
    leave(vertex, start, length);
  }
  return {kNone, kNone};
}

}  // namespace

KeptTopology keep_topology(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                           const VoronoiFaces& faces, std::vector<std::uint8_t>& inside) {
  const SolidParts parts = find_solid_parts(surface);
  if (!parts.all_balls()) return {};
  const Counts counts = count(diagram, faces, inside);
  if (counts.components == parts.count() && counts.euler_characteristic == parts.count()) return {};
  KeptTopology result;
  result.stems.assign(inside.size(), kNone);
  Growth growth(diagram, faces, inside);
  growth.grow_from(max_balls(sampling, parts, diagram, inside));
  std::vector<std::uint8_t> kept = growth.taken();
  for (int bridges = 0; bridges < kMaxBridges; ++bridges) {
    join_by_stems(diagram, inside, kept, result.stems);
    const std::array<Index, 2> bridge = shortest_bridge(diagram, inside, kept);
    if (bridge[0] == kNone) break;
    result.bridges.push_back(bridge);
    growth.grow_from({bridge[0]});
    for (Index i = 0; i < kept.size(); ++i) kept[i] |= growth.taken()[i];
  }
  const auto before = std::count(inside.begin(), inside.end(), std::uint8_t{1});
  const auto after = std::count(kept.begin(), kept.end(), std::uint8_t{1});
  result.left_out = static_cast<Index>(before - after);
  inside = std::move(kept);
  return result;
}

}  // namespace orchard::detail
