#include "edge_gaps.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "../features/sharp_edges.h"

namespace orchard::detail {
namespace {

constexpr double kAt = 1e-9;  // bounding radii: how far rounding moves a place off an edge

// Where two feature edges meet, sheets may pass the corner; where three do, a sheet ends at the corner.
constexpr std::size_t kEdgesOfCorner = 3;

using MeshEdge = std::array<Index, 2>;  // vertices of the mesh, ascending

// The vertices and edges of the complex on one edge of the mesh.
struct Row {
  std::vector<std::pair<double, Index>> places;  // positions along the edge, with the vertex there; ascending
  std::vector<int> along;                        // the number of edges of the complex between a place and the next

  // Adds an edge of the complex between two places: +1 at the first and -1 at the second. Sums of `along` from the left
  // then count the edges.
  void add_edge(const std::pair<double, Index>& a, const std::pair<double, Index>& b) {
    const auto number = [&](const std::pair<double, Index>& place) {
      return static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), place) - places.begin());
    };
    const std::size_t i = number(a), k = number(b);
    ++along[std::min(i, k)];
    --along[std::max(i, k)];
  }
};

std::map<MeshEdge, Row> rows_on_edges(const Surface& surface, const BallComplex& complex,
                                      const FeatureEdges& features) {
  const std::vector<Point>& vertices = surface.mesh().vertices;
  const auto place = [&](const MeshEdge& edge, Index v) {
    const Point& start = vertices[edge[0]];
    return std::pair((vertices[edge[1]] - start).dot(complex.balls[v].center - start), v);
  };
  SharpEdges edges(surface, features);
  std::map<MeshEdge, Row> rows;
  std::vector<std::vector<MeshEdge>> edges_of(complex.size());
  for (Index v = 0; v < complex.size(); ++v) {
    if (complex.balls[v].radius > 0) continue;
    edges.all_at(complex.balls[v].center, kAt * surface.bounding_radius(), edges_of[v]);
    for (const MeshEdge& edge : edges_of[v]) rows[edge].places.push_back(place(edge, v));
  }
  for (auto& [edge, row] : rows) {
    std::sort(row.places.begin(), row.places.end());
    row.along.assign(row.places.size(), 0);
  }
  for (const auto& [a, b] : complex.edges) {
    for (const MeshEdge& edge : edges_of[a]) {
      const bool is_on_it = std::find(edges_of[b].begin(), edges_of[b].end(), edge) != edges_of[b].end();
      if (is_on_it) rows.at(edge).add_edge(place(edge, a), place(edge, b));
    }
  }
  for (auto& [edge, row] : rows) std::partial_sum(row.along.begin(), row.along.end(), row.along.begin());
  return rows;
}

// Returns, for each vertex of the mesh at which feature edges meet, the nearest place on each of these.
std::map<Index, std::vector<Index>> nearest_places(const std::map<MeshEdge, Row>& rows) {
  std::map<Index, std::vector<Index>> nearest;
  for (const auto& [edge, row] : rows) {
    nearest[edge[0]].push_back(row.places.front().second);
    nearest[edge[1]].push_back(row.places.back().second);
  }
  return nearest;
}

}  // namespace

std::vector<std::array<Index, 2>> gaps_on_edges(const Surface& surface, const BallComplex& complex,
                                                const FeatureEdges& features) {
  std::vector<std::array<Index, 2>> gaps;
  const std::map<MeshEdge, Row> rows = rows_on_edges(surface, complex, features);
  for (const auto& [edge, row] : rows) {
    for (std::size_t i = 0; i + 1 < row.places.size(); ++i) {
      if (row.along[i] == 0) gaps.push_back({row.places[i].second, row.places[i + 1].second});
    }
  }
  for (const auto& [corner, places] : nearest_places(rows)) {
    if (places.size() == 2 && places[0] != places[1]) gaps.push_back({places[0], places[1]});
  }
  return gaps;
}

std::vector<EdgeAroundCorner> edges_around_corners(const Surface& surface, const BallComplex& complex,
                                                   const FeatureEdges& features) {
  const EdgeNumbers edge = complex.edge_numbers();
  const auto length = [&](const std::array<Index, 2>& ends) {
    return (complex.balls[ends[0]].center - complex.balls[ends[1]].center).norm();
  };
  std::vector<EdgeAroundCorner> found;
  for (const auto& [corner, places] : nearest_places(rows_on_edges(surface, complex, features))) {
    if (places.size() < kEdgesOfCorner) continue;
    std::array<Index, 2> shortest{kNone, kNone};
    for (std::size_t i = 0; i < places.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        const std::array<Index, 2> ends{std::min(places[i], places[k]), std::max(places[i], places[k])};
        if (!std::binary_search(complex.edges.begin(), complex.edges.end(), ends)) continue;
        if (shortest[0] == kNone || length(ends) < length(shortest)) shortest = ends;
      }
    }
    // If the axis has a vertex at the corner, it is the nearest place on all edges that meet there.
    const bool has_vertex = std::adjacent_find(places.begin(), places.end()) != places.end();
    if (shortest[0] != kNone && !has_vertex) found.push_back({corner, edge(shortest[0], shortest[1])});
  }
  return found;
}

}  // namespace orchard::detail
