#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cell_neighbors.h"
#include "orchard/geometry/surface.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// A convex polygon cut out of a triangle by a Voronoi cell. Edge i runs from corner i to the next one and lies on the
// triangle's edge labels[i] if that is below 3, on the face shared with cell labels[i] - 3 otherwise.
struct CellPolygon {
  std::vector<Point> corners;
  std::vector<Index> labels;
};

// The border between a piece and another cell within the triangle.
struct CellBorder {
  Index cell = kNone;
  std::uint8_t edges = 0;  // bit i: the border ends on the triangle's edge i
};

// The part of one triangle that lies in one Voronoi cell.
struct CellPiece {
  Index cell = kNone;               // number of the cell's point
  std::uint8_t edges = 0;           // bit i: the piece meets the triangle's edge i in more than a touch
  std::vector<CellBorder> borders;  // longer than a touch, ascending by cell
};

// The Voronoi diagram of points restricted to a surface: each triangle is divided among the cells that it lies in. This
// finds all intersections of cell faces with triangles (dissertation 6.2.4), but it starts from the surface: in each
// triangle from the cell that holds a corner, and then across every border that a cell's polygon has within the
// triangle. So unbounded faces are no special case, and faces away from the surface cost nothing.
class RestrictedVoronoi {
 public:
  // All references must outlive this object. Parallel; the result does not depend on the number of threads. O(pieces x
  // neighbours of a cell).
  RestrictedVoronoi(const Surface& surface, std::span<const Point> points, const CellNeighbors& neighbors);

  // Divides those triangles again in which a `changed` cell has a part or may have got one. Returns them, ascending. To
  // be called after `neighbors` was updated.
  std::vector<Index> update(std::span<const Point> points, const std::vector<std::uint8_t>& changed);

  std::span<const CellPiece> pieces(Index triangle) const { return pieces_[triangle]; }  // ascending by cell
  const CellPiece* piece(Index triangle, Index cell) const;                              // null if there is none
  // The piece's shape. Empty corners if the cell does not meet the triangle in more than a touch.
  void polygon(Index triangle, Index cell, CellPolygon& out) const;
  std::span<const Point> points() const { return points_; }

 private:
  struct Scratch;
  void draw_weights();
  void cut_out(const std::array<Point, 3>& triangle, Index cell, Scratch& scratch) const;
  void find_seeds(std::span<const Index> triangles);
  void divide(Index triangle, Scratch& scratch);
  void divide_all(std::span<const Index> triangles);

  const Surface* surface_;
  std::span<const Point> points_;
  const CellNeighbors* neighbors_;
  double touch_;
  std::vector<double> weights_;  // of each point
  std::vector<Index> seeds_;     // for each triangle the point nearest to its first corner
  std::vector<std::vector<CellPiece>> pieces_;
};

}  // namespace orchard::detail
