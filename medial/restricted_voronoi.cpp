#include "restricted_voronoi.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "cell_neighbors.h"
#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// Keeps the part of `polygon` where offset(x) = (x - middle) . direction is at most zero; what it cuts gets `label`.
void clip(CellPolygon& polygon, const Point& middle, const Vector& direction, Index label, std::vector<double>& offsets,
          CellPolygon& spare) {
  const std::size_t size = polygon.corners.size();
  offsets.resize(size);
  bool any_outside = false;
  for (std::size_t i = 0; i < size; ++i) {
    offsets[i] = (polygon.corners[i] - middle).dot(direction);
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

// Whether the polygon is but a touch: its area is less than that of a strip of this width.
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

void cut_out(const std::array<Point, 3>& triangle, std::span<const Point> points, std::span<const Index> neighbors,
             Index cell, double touch, CellPolygon& polygon, std::vector<double>& offsets, CellPolygon& spare) {
  polygon.corners.assign(triangle.begin(), triangle.end());
  polygon.labels = {0, 1, 2};
  for (const Index other : neighbors) {
    const Vector direction = points[other] - points[cell];
    clip(polygon, points[cell] + 0.5 * direction, direction, other + 3, offsets, spare);
    if (polygon.corners.empty()) return;
  }
  if (narrower_than(polygon, touch)) {
    polygon.corners.clear();
    polygon.labels.clear();
  }
}

CellPiece piece_of(const CellPolygon& polygon, const std::array<Point, 3>& triangle, Index cell, double touch) {
  CellPiece piece;
  piece.cell = cell;
  const std::size_t size = polygon.corners.size();
  const auto side = [&](std::size_t i) { return polygon.corners[i + 1 == size ? 0 : i + 1] - polygon.corners[i]; };
  bool last_is_long_border = polygon.labels[size - 1] >= 3 && side(size - 1).squaredNorm() > touch * touch;
  for (std::size_t i = 0; i < size; ++i) {
    for (unsigned corner = 0; corner < 3; ++corner) {
      if (polygon.corners[i] == triangle[corner]) piece.corners |= static_cast<std::uint8_t>(1u << corner);
    }
    const bool is_long = side(i).squaredNorm() > touch * touch;
    const Index label = polygon.labels[i];
    if (is_long && label < 3) piece.edges |= static_cast<std::uint8_t>(1u << label);
    if (is_long && label >= 3) {
      const Index other = label - 3, last = polygon.labels[i == 0 ? size - 1 : i - 1] - 3;
      piece.borders.push_back(other);
      if (last_is_long_border) piece.junctions.push_back({std::min(last, other), std::max(last, other)});
    }
    last_is_long_border = is_long && label >= 3;
  }
  std::sort(piece.borders.begin(), piece.borders.end());
  piece.borders.erase(std::unique(piece.borders.begin(), piece.borders.end()), piece.borders.end());
  return piece;
}

}  // namespace

struct RestrictedVoronoi::Scratch {
  CellPolygon polygon, spare;
  std::vector<double> offsets;
  std::vector<Index> open, seen_by;  // seen_by: the triangle that last met each cell
};

RestrictedVoronoi::RestrictedVoronoi(const Surface& surface, std::span<const Point> points, const Rows& neighbors)
    : surface_(&surface),
      points_(points),
      neighbors_(&neighbors),
      touch_(tolerance::kTouch * surface.bounding_radius()),
      seeds_(surface.mesh().triangles.size(), kNone),
      pieces_(surface.mesh().triangles.size()) {
  divide_all(std::vector<std::uint8_t>(seeds_.size(), 1));
}

void RestrictedVoronoi::update(std::span<const Point> points, const Rows& neighbors,
                               const std::vector<std::uint8_t>& changed) {
  points_ = points;
  neighbors_ = &neighbors;
  // A new cell takes its share from cells that are its neighbours afterwards, so those were marked as changed and their
  // triangles hold all of it.
  std::vector<std::uint8_t> dirty(pieces_.size(), 0);
  tbb::parallel_for(std::size_t{0}, pieces_.size(), [&](std::size_t triangle) {
    for (const CellPiece& piece : pieces_[triangle]) dirty[triangle] |= changed[piece.cell];
  });
  divide_all(dirty);
}

void RestrictedVoronoi::divide_all(const std::vector<std::uint8_t>& dirty) {
  find_seeds(dirty);
  tbb::enumerable_thread_specific<Scratch> scratch;
  tbb::parallel_for(Index{0}, static_cast<Index>(pieces_.size()), [&](Index triangle) {
    if (dirty[triangle]) divide(triangle, scratch.local());
  });
}

// Serial, each walk starting where a neighbour's ended, so that ties fall the same way whatever the thread count.
void RestrictedVoronoi::find_seeds(const std::vector<std::uint8_t>& dirty) {
  Index last = 0;
  while (last + 1 < neighbors_->size() && (*neighbors_)[last].empty()) ++last;
  for (Index triangle = 0; triangle < seeds_.size(); ++triangle) {
    if (!dirty[triangle]) continue;
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
    cut_out(corners, points_, (*neighbors_)[cell], cell, touch_, scratch.polygon, scratch.offsets, scratch.spare);
    if (scratch.polygon.corners.empty()) {
      // A seed that ties with others for the corner may own nothing else of the triangle; one of its neighbours does.
      if (pieces.empty() && cell == seeds_[triangle]) {
        for (const Index other : (*neighbors_)[cell]) meet(other);
      }
      continue;
    }
    pieces.push_back(piece_of(scratch.polygon, corners, cell, touch_));
    for (const Index other : pieces.back().borders) meet(other);
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
  std::vector<double> offsets;
  CellPolygon spare;
  cut_out(surface_->corners(triangle), points_, (*neighbors_)[cell], cell, touch_, out, offsets, spare);
}

}  // namespace orchard::detail
