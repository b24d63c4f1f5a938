#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "../axis/incidence.h"
#include "quality_parts.h"

namespace orchard::detail {
namespace {

constexpr double kCoverageAccuracy = 1e-5;    // of the diagonal: the accuracy to which the maximum is searched
constexpr std::size_t kMaxParts = 1'000'000;  // the maximum number of parts of triangles that are examined
// The number of vertices or triangles of one task, which are processed in order.
constexpr std::size_t kCoverageBlock = 256;
// Of the diagonal: rounding may put a place this far from a border that it lies on.
constexpr double kBesideBorder = 1e-9;

// Returns the borders of sheets, the free ends of curves and the balls without edges, as degenerate triangles.
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

// The distance to one cell is a convex function, so it is largest at a corner.
double max_to_cell(const Reconstruction& reconstruction, Index cell, const Corners& corners) {
  return std::max({reconstruction.distance_to_cell(cell, corners[0]), reconstruction.distance_to_cell(cell, corners[1]),
                   reconstruction.distance_to_cell(cell, corners[2])});
}

struct Near {
  double distance;
  Index cell;
};

// Returns the nearest cell, or any cell that is nearer than `enough`. The cell `guess` (kNone for none) is tried first.
Near near_cell(const Reconstruction& reconstruction, const Point& place, Index guess, double enough) {
  if (guess != kNone) {
    const double distance = reconstruction.distance_to_cell(guess, place);
    if (distance < enough) return {distance, guess};
  }
  const Reconstruction::Nearest nearest = reconstruction.nearest(place, enough);
  return {nearest.distance, nearest.cell};
}

// Calls `visit(i, cell)` in parallel, in blocks. Within a block, each call gets the cell that the previous call has
// left.
template <class Visit>
void for_each_in_turn(std::size_t count, const Visit& visit) {
  tbb::parallel_for(std::size_t{0}, (count + kCoverageBlock - 1) / kCoverageBlock, [&](std::size_t block) {
    Index cell = kNone;
    const std::size_t end = std::min(count, (block + 1) * kCoverageBlock);
    for (std::size_t i = block * kCoverageBlock; i < end; ++i) visit(i, cell);
  });
}

// The distance to all cells is 1-Lipschitz. `cell` is the cell nearest to the middle of the triangle that this one is a
// half of; mostly it is near enough.
PieceValue coverage_of(const Corners& corners, const Reconstruction& reconstruction, Index cell, double enough) {
  PieceValue piece{
      .value = -std::numeric_limits<double>::infinity(),
      .bound = cell == kNone ? std::numeric_limits<double>::infinity() : max_to_cell(reconstruction, cell, corners),
      .place = (corners[0] + corners[1] + corners[2]) / 3,
      .cell = cell};
  if (piece.bound <= enough) return piece;
  const Reconstruction::Nearest nearest = reconstruction.nearest(piece.place);
  piece.value = nearest.distance;
  piece.cell = nearest.cell;
  double reach = 0;
  for (const Point& corner : corners) reach = std::max(reach, (corner - piece.place).norm());
  piece.bound = std::min({piece.bound, piece.value + reach, max_to_cell(reconstruction, nearest.cell, corners)});
  return piece;
}

}  // namespace

MaxOverTriangles max_coverage(const Surface& surface, const Reconstruction& reconstruction, MaxOverTriangles known,
                              double diagonal) {
  const std::vector<Point>& vertices = surface.mesh().vertices;
  std::vector<Near> at_vertices(vertices.size());
  for_each_in_turn(vertices.size(), [&](std::size_t v, Index& cell) {
    at_vertices[v] = near_cell(reconstruction, vertices[v], cell, known.max);
    cell = at_vertices[v].cell;
  });
  const auto farthest = std::max_element(at_vertices.begin(), at_vertices.end(),
                                         [](const Near& a, const Near& b) { return a.distance < b.distance; });
  if (farthest->distance > known.max)
    known = {farthest->distance, 0, vertices[static_cast<std::size_t>(farthest - at_vertices.begin())]};
  // A corner needs no search if its cell is near enough.
  const double enough = known.max + kCoverageAccuracy * diagonal;
  std::vector<double> bounds(surface.mesh().triangles.size());
  for_each_in_turn(bounds.size(), [&](std::size_t t, Index&) {
    const Corners corners = surface.corners(static_cast<Index>(t));
    bounds[t] = std::numeric_limits<double>::infinity();
    for (const Index v : surface.mesh().triangles[t]) {
      if (bounds[t] > enough)
        bounds[t] = std::min(bounds[t], max_to_cell(reconstruction, at_vertices[v].cell, corners));
    }
  });
  std::vector<Corners> triangles;
  double closed = known.max;
  for (std::size_t t = 0; t < bounds.size(); ++t) {
    if (bounds[t] > enough) {
      triangles.push_back(surface.corners(static_cast<Index>(t)));
    } else {
      closed = std::max(closed, bounds[t]);
    }
  }
  MaxOverTriangles found = max_over_triangles(triangles, known, kCoverageAccuracy * diagonal, kMaxParts,
                                              [&](const Corners& corners, Index cell, double limit) {
                                                return coverage_of(corners, reconstruction, cell, limit);
                                              });
  found.upper = std::max(found.upper, closed);
  return found;
}

Spread inner_coverage(const MedialMesh& mesh, std::span<const SurfaceReach> reaches, double diagonal) {
  constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
  if (mesh.edges.empty() && mesh.triangles.empty()) return {.max = kUndefined, .mean = kUndefined};
  std::vector<double> inner(reaches.size());
  TriangleMesh borders = borders_of(mesh);
  if (borders.triangles.empty()) {
    for (std::size_t i = 0; i < reaches.size(); ++i) inner[i] = reaches[i].uncovered;
    return spread_of(inner);
  }
  const Surface at_borders(std::move(borders));
  tbb::parallel_for(std::size_t{0}, reaches.size(), [&](std::size_t i) {
    const SurfaceReach& reach = reaches[i];
    if (reach.uncovered > 0 && at_borders.distance(reach.ball.center) > kBesideBorder * diagonal)
      inner[i] = reach.uncovered;
  });
  return spread_of(inner);
}

}  // namespace orchard::detail
