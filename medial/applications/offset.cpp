#include "orchard/medial/offset.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "../simplify/level_set.h"
#include "offset_bound.h"
#include "orchard/geometry/error.h"

namespace orchard {
namespace {

constexpr double kBoundAccuracy = 0.02;  // tolerances
// Number of parts in addition to the triangles; they take a minute at most.
constexpr std::size_t kMaxOffsetParts = 4'000'000;
constexpr double kMostCells = 2e7;         // of a grid: some ten gigabytes
constexpr double kClearOfWall = 1 + 1e-3;  // cells that a cavity is deeper than the wall at first
// Tolerances: by how much a cavity stays deeper than the wall when it is made again with the depth that it had to
// spare.
constexpr double kSpareDepth = 0.05;

void require_offset_options(const Surface& surface, const OffsetOptions& options) {
  if (!(options.distance > 0) || !(options.distance <= kMaxCoordinate))
    throw InputError("the distance of an offset is to be above 0");
  if (!(options.tolerance >= kMinOffsetTolerance && options.tolerance <= 0.5))
    throw InputError("the tolerance of an offset is to be from 0.0002 to 0.5 diagonals");
  if (options.side != OffsetSide::both && !surface.solid())
    throw InputError("an offset on one side needs a solid: " + surface.report().faults() +
                     "; a shell on both sides does not");
}

double value_at(const Surface& surface, OffsetSide side, double distance, const Point& place) {
  if (side == OffsetSide::both) return surface.distance(place) - distance;
  const double own = surface.signed_distance(place);
  return side == OffsetSide::outside ? own - distance : own + distance;
}

// This is an estimate: the offset surface has about the area of the given surface, and each grid cell of that area
// takes some two cubes.
void require_room(const Surface& surface, double cell) {
  if (2 * surface.report().area / (cell * cell) <= kMostCells) return;
  const double diagonal = surface.bounding_box().diagonal().norm();
  const double enough = std::sqrt(2 * surface.report().area / kMostCells) * std::sqrt(3.0) / diagonal;
  throw InputError("the offset would need more than 20 million cells; a tolerance of " + std::to_string(100 * enough) +
                   " % of the diagonal can be kept, with a distance above " + std::to_string(2 * enough * diagonal));
}

// The level set at `distance` on a grid of cells.
OffsetMesh level_mesh(const Surface& surface, OffsetSide side, double distance, double cell, double tolerance,
                      const Progress& progress) {
  require_room(surface, cell);
  Box box = surface.bounding_box();
  if (side != OffsetSide::inside) {
    box.min().array() -= distance;
    box.max().array() += distance;
  }
  if (side != OffsetSide::both) surface.self_intersections();  // which signed distances need
  detail::LevelSet level([&](const Point& place) { return value_at(surface, side, distance, place); }, box, cell,
                         progress, "meshing the offset");
  OffsetMesh result{.mesh = level.mesh(), .distance = distance, .tolerance = tolerance, .cell = cell};
  if (result.mesh.triangles.empty()) return result;
  const detail::DistanceRange range =
      detail::distance_range(result.mesh, surface, kBoundAccuracy * tolerance, kMaxOffsetParts);
  result.min_distance = range.min;
  result.max_distance = range.max;
  result.nearest = range.nearest;
  result.farthest = range.farthest;
  return result;
}

// A shell is thin, so its cells must be so small that its inside does not fall between the corners of the grid.
double cell_for(OffsetSide side, double tolerance, double distance) {
  const double cell = tolerance / (std::sqrt(3.0) * (1 + 1e-9));
  return side == OffsetSide::both ? std::min(cell, distance / 2) : cell;
}

void require_any(const OffsetMesh& offset) {
  if (offset.mesh.triangles.empty())
    throw InputError("no part of the solid is deeper than " + std::to_string(offset.distance) +
                     " by more than the grid's cells show; take a smaller distance or tolerance");
}

// The cavity of a wall. No place of a triangle is farther from a corner of it than a cell, so that a level one cell
// deeper keeps the wall. Most meshes need far less: once it is proven what the first one keeps to spare, the second one
// is less deep by that.
OffsetMesh cavity_of(const Surface& surface, double wall, double cell, double tolerance, const Progress& progress) {
  const double depth = wall + kClearOfWall * cell;
  OffsetMesh first = level_mesh(surface, OffsetSide::inside, depth, cell, tolerance, progress);
  require_any(first);
  const double spare = first.min_distance - wall - kSpareDepth * tolerance;
  if (!(spare > kSpareDepth * tolerance)) return first;
  OffsetMesh second = level_mesh(surface, OffsetSide::inside, depth - spare, cell, tolerance, progress);
  return second.min_distance >= wall ? second : first;
}

}  // namespace

double OffsetMesh::error() const { return std::max(max_distance - distance, distance - min_distance); }

OffsetMesh offset_mesh(const Surface& surface, const OffsetOptions& options, const Progress& progress) {
  require_offset_options(surface, options);
  const double tolerance = options.tolerance * surface.bounding_box().diagonal().norm();
  OffsetMesh result = level_mesh(surface, options.side, options.distance,
                                 cell_for(options.side, tolerance, options.distance), tolerance, progress);
  require_any(result);
  return result;
}

HollowMesh hollow_mesh(const Surface& surface, double wall, const OffsetOptions& options, const Progress& progress) {
  OffsetOptions own = options;
  own.distance = wall;
  own.side = OffsetSide::inside;
  require_offset_options(surface, own);
  const double tolerance = own.tolerance * surface.bounding_box().diagonal().norm(),
               cell = cell_for(own.side, tolerance, wall);
  HollowMesh result;
  result.cavity = cavity_of(surface, wall, cell, tolerance, progress);
  result.min_wall = result.cavity.min_distance;
  result.mesh = surface.mesh();
  const auto first = static_cast<Index>(result.mesh.vertices.size());
  const TriangleMesh& cavity = result.cavity.mesh;
  result.mesh.vertices.insert(result.mesh.vertices.end(), cavity.vertices.begin(), cavity.vertices.end());
  for (const auto& [a, b, c] : cavity.triangles) result.mesh.triangles.push_back({first + a, first + c, first + b});
  return result;
}

}  // namespace orchard
