#include "restricted_voronoi.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "orchard/geometry/random.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// Keeps the part of `polygon` where (x - base) . direction <= bound. The edges along which it is cut get `label`.
void clip(CellPolygon& polygon, const Point& base, const Vector& direction, double bound, Index label,
          std::vector<double>& offsets, CellPolygon& spare) {
  const std::size_t size = polygon.corners.size();
  offsets.resize(size);
  bool any_outside = false;
  for (std::size_t i = 0; i < size; ++i) {
    offsets[i] = (polygon.corners[i] - base).dot(direction) - bound;
    any_outside = any_outside || offsets[i] > 0;
  }
  if (!any_outside) return;
  spare.corners.clear();
  spare.labels.clear();
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t next = i + 1 == size ? 0 : i + 1;
    const bool inside = offsets[i] <= 0, next_inside = offsets[next] <= 0;
    if (inside) {
      spare.corners.push_back(polygon.corners[i]);
      spare.labels.push_back(polygon.labels[i]);
    }
    if (inside == next_inside) continue;
    const double fraction = offsets[i] / (offsets[i] - offsets[next]);
    const Point crossing = polygon.corners[i] + fraction * (polygon.corners[next] - polygon.corners[i]);
    spare.corners.push_back(crossing);
    spare.labels.push_back(inside ? label : polygon.labels[i]);
  }
  std::swap(polygon, spare);
}

// Whether the polygon is so thin that it counts as a mere touch: its area is less than that of a strip of this width.
bool narrower_than(const CellPolygon& polygon, double width) {
  Vector area = Vector::Zero();
  double squared = 0;
  for (std::size_t i = 1; i < polygon.corners.size(); ++i) {
    const Vector reach = polygon.corners[i] - polygon.corners[0];
    squared = std::max(squared, reach.squaredNorm());
    if (i > 1) area += (polygon.corners[i - 1] - polygon.corners[0]).cross(reach);
  }
  return !(area.squaredNorm() > width * width * squared);
}

CellPiece piece_of(const CellPolygon& polygon, Index cell, double touch) {
  CellPiece piece;
  piece.cell = cell;
  const std::size_t size = polygon.corners.size();
  const auto bit = [](Index label) { return static_cast<std::uint8_t>(label < 3 ? 1u << label : 0u); };
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t next = i + 1 == size ? 0 : i + 1, last = i == 0 ? size - 1 : i - 1;
    if (!((polygon.corners[next] - polygon.corners[i]).squaredNorm() > touch * touch)) continue;
    if (polygon.labels[i] < 3) {
      piece.edges |= bit(polygon.labels[i]);
    } else {
      const auto ends = static_cast<std::uint8_t>(bit(polygon.labels[last]) | bit(polygon.labels[next]));
      piece.borders.push_back({polygon.labels[i] - 3, ends});
    }
  }
  std::sort(piece.borders.begin(), piece.borders.end(),
            [](const CellBorder& a, const CellBorder& b) { return a.cell < b.cell; });
  return piece;
}

}  // namespace

struct RestrictedVoronoi::Scratch {
  CellPolygon polygon, spare;
  std::vector<double> offsets;
  std::vector<Index> open, seen_by;  // seen_by has, for each cell, the triangle that it was last seen from
};

// Cuts the part of a triangle in a cell. Leaves scratch.polygon without corners if the cell merely touches the
// triangle.
void RestrictedVoronoi::cut_out(const std::array<Point, 3>& triangle, Index cell, Scratch& scratch) const {
  CellPolygon& polygon = scratch.polygon;
  polygon.corners.assign(triangle.begin(), triangle.end());
  polygon.labels = {0, 1, 2};
  for (const Index other : (*neighbors_)[cell]) {
    const Vector direction = points_[other] - points_[cell];
    const double bound = 0.5 * (direction.squaredNorm() + weights_[cell] - weights_[other]);
    clip(polygon, points_[cell], direction, bound, other + 3, scratch.offsets, scratch.spare);
    if (polygon.corners.empty()) return;
  }
  if (narrower_than(polygon, touch_)) {
    polygon.corners.clear();
    polygon.labels.clear();
  }
}

// Draws a random weight for each point. It is proportional to the distance to the nearest neighbour, so that no face
// moves by more than the tolerance and no point loses its cell. Points that have a weight keep it, because the cells of
// their neighbours were cut with it.
void RestrictedVoronoi::draw_weights() {
  const double unit = tolerance::kGeneralPosition * surface_->bounding_radius();
  const Index first = static_cast<Index>(weights_.size());
  weights_.resize(points_.size());
  tbb::parallel_for(first, static_cast<Index>(points_.size()), [&](Index point) {
    double squared = std::numeric_limits<double>::infinity();
    for (const Index other : (*neighbors_)[point]) {
      squared = std::min(squared, (points_[other] - points_[point]).squaredNorm());
    }
    weights_[point] = (*neighbors_)[point].empty() ? 0 : unit * std::sqrt(squared) * Random(0, 0, point).uniform(-1, 1);
  });
}

RestrictedVoronoi::RestrictedVoronoi(const Surface& surface, std::span<const Point> points,
                                     const CellNeighbors& neighbors)
    : surface_(&surface),
      points_(points),
      neighbors_(&neighbors),
      touch_(tolerance::kTouch * surface.bounding_radius()),
      seeds_(surface.mesh().triangles.size(), kNone),
      pieces_(surface.mesh().triangles.size()) {
  draw_weights();
  std::vector<Index> all(pieces_.size());
  std::iota(all.begin(), all.end(), Index{0});
  divide_all(all);
}

std::vector<Index> RestrictedVoronoi::update(std::span<const Point> points, const std::vector<std::uint8_t>& changed) {
  points_ = points;
  draw_weights();
  // A new cell takes its area from cells that are its neighbours afterwards. Those were marked as changed, so their
  // triangles contain the whole new cell.
  std::vector<Index> dirty;
  for (Index triangle = 0; triangle < pieces_.size(); ++triangle) {
    const std::vector<CellPiece>& pieces = pieces_[triangle];
    const bool hit =
        std::any_of(pieces.begin(), pieces.end(), [&](const CellPiece& piece) { return changed[piece.cell] != 0; });
    if (hit) dirty.push_back(triangle);
  }
  divide_all(dirty);
  return dirty;
}

void RestrictedVoronoi::divide_all(std::span<const Index> triangles) {
  find_seeds(triangles);
  tbb::enumerable_thread_specific<Scratch> scratch;
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t i) { divide(triangles[i], scratch.local()); });
}

// Runs in one thread, with each walk starting where the walk of a neighbour ended. So ties are resolved in the same way
// for any number of threads.
void RestrictedVoronoi::find_seeds(std::span<const Index> triangles) {
  Index last = 0;
  while (last + 1 < neighbors_->size() && (*neighbors_)[last].empty()) ++last;
  for (const Index triangle : triangles) {
    Index start = seeds_[triangle];
    for (const Index next : surface_->neighbors(triangle)) {
      if (start == kNone && next != kNone) start = seeds_[next];
    }
    if (start == kNone) start = last;
    const Point& corner = surface_->mesh().vertices[surface_->mesh().triangles[triangle][0]];
    last = seeds_[triangle] = nearest_point(points_, *neighbors_, corner, start);
  }
}

void RestrictedVoronoi::divide(Index triangle, Scratch& scratch) {
  const std::array<Point, 3> corners = surface_->corners(triangle);
  std::vector<CellPiece>& pieces = pieces_[triangle];
  pieces.clear();
  scratch.seen_by.resize(points_.size(), kNone);
  const auto meet = [&](Index cell) {
    if (scratch.seen_by[cell] == triangle) return;
    scratch.seen_by[cell] = triangle;
    scratch.open.push_back(cell);
  };
  meet(seeds_[triangle]);
  while (!scratch.open.empty()) {
    const Index cell = scratch.open.back();
    scratch.open.pop_back();
    cut_out(corners, cell, scratch);
    if (scratch.polygon.corners.empty()) {
      // A seed that ties with others at the corner may own nothing else of the triangle. Then one of its neighbours
      // does.
      if (pieces.empty() && cell == seeds_[triangle]) {
        for (const Index other : (*neighbors_)[cell]) meet(other);
      }
      continue;
    }
    pieces.push_back(piece_of(scratch.polygon, cell, touch_));
    for (const CellBorder& border : pieces.back().borders) meet(border.cell);
  }
  std::sort(pieces.begin(), pieces.end(), [](const CellPiece& a, const CellPiece& b) { return a.cell < b.cell; });
}

const CellPiece* RestrictedVoronoi::piece(Index triangle, Index cell) const {
  const std::vector<CellPiece>& pieces = pieces_[triangle];
  const auto found =
      std::lower_bound(pieces.begin(), pieces.end(), cell, [](const CellPiece& a, Index b) { return a.cell < b; });
  return found != pieces.end() && found->cell == cell ? &*found : nullptr;
}

void RestrictedVoronoi::polygon(Index triangle, Index cell, CellPolygon& out) const {
  Scratch scratch;
  cut_out(surface_->corners(triangle), cell, scratch);
  out = std::move(scratch.polygon);
}

}  // namespace orchard::detail
