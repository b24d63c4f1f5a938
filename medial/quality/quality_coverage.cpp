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
  return max_over_triangles(triangles, known, kAccuracy * diagonal, kMaxParts, [&](const Corners& corners) {
    PieceValue piece{.value = 0, .bound = 0, .place = (corners[0] + corners[1] + corners[2]) / 3};
    const Reconstruction::Nearest nearest = reconstruction.nearest(piece.place);
    piece.value = nearest.distance;
    // The distance is 1-Lipschitz, and to a single cell it is convex.
    double reach = 0, at_corners = piece.value;
    for (const Point& corner : corners) {
      reach = std::max(reach, (corner - piece.place).norm());
      at_corners = std::max(at_corners, reconstruction.distance_to_cell(nearest.cell, corner));
    }
    piece.bound = std::min(piece.value + reach, at_corners);
    return piece;
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
