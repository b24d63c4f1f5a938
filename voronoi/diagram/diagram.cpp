#include "orchard/voronoi/diagram.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>

#include "orchard/geometry/error.h"
#include "orchard/voronoi/views.h"

namespace orchard {
namespace {

constexpr std::array<std::array<unsigned, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

unsigned slot_of(const std::array<Index, 4>& four, Index item) {
  return static_cast<unsigned>(std::find(four.begin(), four.end(), item) - four.begin());
}

unsigned edge_between(unsigned i, unsigned j) {
  if (i > j) std::swap(i, j);
  return i == 0 ? j - 1 : i + j;
}

// A face of the diagram, given by the edge of the Delaunay triangulation that it is dual to, and a vertex on it.
struct Ring {
  Index first_point, second_point, vertex;
};

VoronoiFace face_of(const VoronoiDiagram& diagram, const Ring& ring) {
  const auto& corner = diagram.vertices[ring.vertex].forming_points;
  return {diagram, ring.vertex, slot_of(corner, ring.first_point), slot_of(corner, ring.second_point)};
}

// Returns every edge of the Delaunay triangulation once, those to infinity included, in the order of their first
// vertex. The first point of an edge is the lower one. kInfinitePoint is the highest number, so it always comes second.
std::vector<Ring> rings(const VoronoiDiagram& diagram) {
  std::vector<std::uint8_t> seen(diagram.vertices.size(), 0);
  std::vector<Ring> all;
  all.reserve(diagram.vertices.size() * 6 / 5);
  for (Index v = 0; v < diagram.vertices.size(); ++v) {
    const auto& corner = diagram.vertices[v].forming_points;
    for (unsigned e = 0; e < 6; ++e) {
      if (seen[v] & (1u << e)) continue;
      const auto [low, high] = std::minmax(corner[kEdges[e][0]], corner[kEdges[e][1]]);
      all.push_back({low, high, v});
      for (const Index w : face_of(diagram, all.back())) {
        const auto& other = diagram.vertices[w].forming_points;
        const unsigned edge = edge_between(slot_of(other, low), slot_of(other, high));
        seen[w] = static_cast<std::uint8_t>(seen[w] | (1u << edge));
      }
    }
  }
  return all;
}

// Sorts by first point with a counting sort, and then the few rings of each point by second point.
std::vector<Ring> sorted(const std::vector<Ring>& all, std::size_t point_count) {
  std::vector<Index> start(point_count + 1, 0);
  for (const Ring& ring : all) ++start[ring.first_point + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Ring> result(all.size());
  std::vector<Index> next(start.begin(), start.end() - 1);
  for (const Ring& ring : all) result[next[ring.first_point]++] = ring;
  for (std::size_t p = 0; p < point_count; ++p)
    std::sort(result.begin() + start[p], result.begin() + start[p + 1],
              [](const Ring& a, const Ring& b) { return a.second_point < b.second_point; });
  return result;
}

[[noreturn]] void fail(const std::string& what, Index vertex) {
  throw Error("inconsistent Voronoi diagram: vertex " + std::to_string(vertex) + ": " + what);
}

void check_vertex(const VoronoiDiagram& diagram, Index v) {
  const VoronoiVertex& vertex = diagram.vertices[v];
  for (unsigned i = 0; i < 4; ++i) {
    const Index point = vertex.forming_points[i];
    if (point != kInfinitePoint && point >= diagram.points.size()) fail("a forming point is out of range", v);
    for (unsigned j = 0; j < i; ++j)
      if (vertex.forming_points[j] == point) fail("a forming point appears twice", v);
    if (vertex.neighbors[i] >= diagram.vertices.size()) fail("a neighbour is out of range", v);
  }
}

void check_neighbors(const VoronoiDiagram& diagram, Index v) {
  const VoronoiVertex& vertex = diagram.vertices[v];
  for (unsigned i = 0; i < 4; ++i) {
    const VoronoiVertex& other = diagram.vertices[vertex.neighbors[i]];
    const unsigned back = slot_of(other.neighbors, v);
    if (back == 4) fail("a neighbour does not name it as its own", v);
    // If the i-th forming point is replaced by the neighbour's own point, the four have to be an odd permutation of the
    // neighbour's points: the same points, seen from the other side of the three that they share.
    std::array<Index, 4> corner = vertex.forming_points;
    if (corner[i] == other.forming_points[back]) fail("it has the forming points of a neighbour", v);
    corner[i] = other.forming_points[back];
    unsigned swaps = 0;
    for (unsigned k = 0; k < 4; ++k) {
      const unsigned from = slot_of(corner, other.forming_points[k]);
      if (from == 4) fail("it does not share three forming points with a neighbour", v);
      if (from == k) continue;
      std::swap(corner[from], corner[k]);
      ++swaps;
    }
    if (swaps % 2 == 0) fail("it is not oriented like a neighbour", v);
  }
}

void check_no_vertex_twice(const VoronoiDiagram& diagram) {
  std::vector<std::array<Index, 4>> sets;
  sets.reserve(diagram.vertices.size());
  for (const VoronoiVertex& vertex : diagram.vertices) {
    sets.push_back(vertex.forming_points);
    std::sort(sets.back().begin(), sets.back().end());
  }
  std::sort(sets.begin(), sets.end());
  if (std::adjacent_find(sets.begin(), sets.end()) != sets.end())
    throw Error("inconsistent Voronoi diagram: two vertices have the same forming points");
}

// Checks that the vertices of one cell, the edges between them and its faces form a sphere: they have one component,
// and fulfil Euler's formula V - E + F = 2 with E = 3 V / 2, since three edges of a cell meet in each of its vertices.
void check_cell(const VoronoiDiagram& diagram, Index point, std::span<const Index> cell, Index faces,
                std::vector<Index>& stamp, std::vector<Index>& stack) {
  const Index mark = point == kInfinitePoint ? static_cast<Index>(diagram.points.size()) : point;
  stack.assign(1, cell.front());
  stamp[cell.front()] = mark;
  std::size_t reached = 0;
  while (!stack.empty()) {
    const VoronoiVertex& vertex = diagram.vertices[stack.back()];
    stack.pop_back();
    ++reached;
    for (unsigned i = 0; i < 4; ++i) {
      if (vertex.forming_points[i] == point || stamp[vertex.neighbors[i]] == mark) continue;
      stamp[vertex.neighbors[i]] = mark;
      stack.push_back(vertex.neighbors[i]);
    }
  }
  if (reached != cell.size() || 2 * std::size_t{faces} != cell.size() + 4)
    throw Error("inconsistent Voronoi diagram: the cell of point " + std::to_string(point) +
                " is not simply connected");
}

}  // namespace

VoronoiFaces voronoi_faces(const VoronoiDiagram& diagram) {
  std::vector<Ring> all = rings(diagram);
  std::erase_if(all, [](const Ring& ring) { return ring.second_point == kInfinitePoint; });
  VoronoiFaces faces;
  faces.points.reserve(all.size());
  faces.vertices.offsets.reserve(all.size() + 1);
  for (const Ring& ring : sorted(all, diagram.points.size())) {
    faces.points.push_back({ring.first_point, ring.second_point});
    for (const Index v : face_of(diagram, ring)) faces.vertices.items.push_back(v);
    faces.vertices.close_row();
  }
  return faces;
}

Rows vertices_of_points(const VoronoiDiagram& diagram) {
  Rows rows;
  rows.offsets.assign(diagram.points.size() + 1, 0);
  for (const VoronoiVertex& vertex : diagram.vertices)
    for (Index point : vertex.forming_points)
      if (point != kInfinitePoint) ++rows.offsets[point + 1];
  std::partial_sum(rows.offsets.begin(), rows.offsets.end(), rows.offsets.begin());
  rows.items.resize(rows.offsets.back());
  std::vector<Index> next(rows.offsets.begin(), rows.offsets.end() - 1);
  for (Index v = 0; v < diagram.vertices.size(); ++v)
    for (Index point : diagram.vertices[v].forming_points)
      if (point != kInfinitePoint) rows.items[next[point]++] = v;
  return rows;
}

void validate(const VoronoiDiagram& diagram) {
  if (diagram.vertices.empty()) return;
  const auto vertex_count = static_cast<Index>(diagram.vertices.size());
  const auto point_count = static_cast<Index>(diagram.points.size());
  for (Index v = 0; v < vertex_count; ++v) check_vertex(diagram, v);
  for (Index v = 0; v < vertex_count; ++v) check_neighbors(diagram, v);
  check_no_vertex_twice(diagram);

  // All neighbour relations have been checked, so walking around an edge ends.
  std::vector<Ring> edges = rings(diagram);
  std::vector<Index> face_count(point_count + 1, 0);  // the last one is that of the point at infinity
  const auto place = [&](Index point) { return point == kInfinitePoint ? point_count : point; };
  for (const Ring& edge : edges) ++face_count[place(edge.first_point)], ++face_count[place(edge.second_point)];
  const auto cells = static_cast<std::int64_t>(
      std::count_if(face_count.begin(), face_count.end(), [](Index faces) { return faces > 0; }));
  if (cells - static_cast<std::int64_t>(edges.size()) + static_cast<std::int64_t>(vertex_count) != 0)
    throw Error("inconsistent Voronoi diagram: Euler's formula does not hold");
  edges = sorted(edges, point_count);
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].first_point == edges[i - 1].first_point && edges[i].second_point == edges[i - 1].second_point)
      throw Error("inconsistent Voronoi diagram: the cells of points " + std::to_string(edges[i].first_point) +
                  " and " + std::to_string(edges[i].second_point) + " share two faces");

  const Rows cell_vertices = vertices_of_points(diagram);
  std::vector<Index> stamp(vertex_count, kNone), stack, outside;
  for (Index p = 0; p < point_count; ++p)
    if (!cell_vertices[p].empty()) check_cell(diagram, p, cell_vertices[p], face_count[p], stamp, stack);
  for (Index v = 0; v < vertex_count; ++v)
    if (diagram.vertices[v].at_infinity()) outside.push_back(v);
  if (outside.empty()) throw Error("inconsistent Voronoi diagram: it has no vertices at infinity");
  check_cell(diagram, kInfinitePoint, outside, face_count[point_count], stamp, stack);
}

}  // namespace orchard
