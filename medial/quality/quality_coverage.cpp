#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "../axis/incidence.h"
#include "quality_parts.h"

namespace orchard::detail {
namespace {

constexpr double kAccuracy = 1e-5;            // of the diagonal: to which the maximum is searched
constexpr std::size_t kMaxParts = 1'000'000;  // of the surface's triangles that are looked at
constexpr double kOnBorder = 1e-9;            // of the diagonal: what rounding puts beside a border

// The borders of sheets, the free ends of wires and the balls without edges, as flat triangles.
TriangleMesh borders_of(const MedialMesh& mesh) {
  TriangleMesh borders{.vertices = mesh.centers, .triangles = {}};
  const CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  for (const Index e : at.border_edges())
    borders.triangles.push_back({mesh.edges[e][0], mesh.edges[e][1], mesh.edges[e][1]});
  for (Index v = 0; v < mesh.size(); ++v) {
    const auto edges = at.edges_at[v];
    if (edges.empty() || (edges.size() == 1 && at.triangles_at[edges.front()].empty()))
      borders.triangles.push_back({v, v, v});
  }
  return borders;
}

// The distance to one cell is convex, so that it is nowhere more than at the corners; to all of them it is 1-Lipschitz.
// `cell`: the one nearest to the middle of the whole that this is half of, which will mostly do.
PieceValue coverage_of(const Corners& corners, const Reconstruction& reconstruction, Index cell, double enough) {
  const auto max_to_cell = [&](Index of) {
    return std::max({reconstruction.distance_to_cell(of, corners[0]), reconstruction.distance_to_cell(of, corners[1]),
                     reconstruction.distance_to_cell(of, corners[2])});
  };
  PieceValue piece{.value = -std::numeric_limits<double>::infinity(),
                   .bound = cell == kNone ? std::numeric_limits<double>::infinity() : max_to_cell(cell),
                   .place = (corners[0] + corners[1] + corners[2]) / 3,
                   .cell = cell};
  if (piece.bound <= enough) return piece;
  const Reconstruction::Nearest nearest = reconstruction.nearest(piece.place);
  piece.value = nearest.distance;
  piece.cell = nearest.cell;
  double reach = 0;
  for (const Point& corner : corners) reach = std::max(reach, (corner - piece.place).norm());
  piece.bound = std::min({piece.bound, piece.value + reach, max_to_cell(nearest.cell)});
  return piece;
}

}  // namespace

MaxOverTriangles max_coverage(const Surface& surface, const Reconstruction& reconstruction, MaxOverTriangles known,
                              double diagonal) {
  const std::vector<Point>& vertices = surface.mesh().vertices;
  std::vector<double> at_vertices(vertices.size());
  // Any ball that is nearer than what is known shows that the maximum is elsewhere.
  tbb::parallel_for(std::size_t{0}, vertices.size(), [&](std::size_t v) {
    Sphere ball;
    at_vertices[v] =
        reconstruction.distance_between(known.max, std::numeric_limits<double>::infinity(), vertices[v], ball);
  });
  const auto farthest = std::max_element(at_vertices.begin(), at_vertices.end());
  if (*farthest > known.max) known = {*farthest, 0, vertices[static_cast<std::size_t>(farthest - at_vertices.begin())]};
  std::vector<Corners> triangles;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) triangles.push_back(surface.corners(t));
  return max_over_triangles(triangles, known, kAccuracy * diagonal, kMaxParts,
                            [&](const Corners& corners, Index cell, double enough) {
                              return coverage_of(corners, reconstruction, cell, enough);
                            });
}

Spread inner_coverage(const MedialMesh& mesh, std::span<const SurfaceReach> reaches, double diagonal) {
  std::vector<double> inner(reaches.size());
  TriangleMesh borders = borders_of(mesh);
  if (borders.triangles.empty()) {
    for (std::size_t i = 0; i < reaches.size(); ++i) inner[i] = reaches[i].uncovered;
    return spread_of(inner);
  }
  const Surface at_borders(std::move(borders));
  tbb::parallel_for(std::size_t{0}, reaches.size(), [&](std::size_t i) {
    const SurfaceReach& reach = reaches[i];
    if (reach.uncovered > 0 && at_borders.distance(reach.ball.center) > kOnBorder * diagonal)
      inner[i] = reach.uncovered;
  });
  return spread_of(inner);
}

}  // namespace orchard::detail
