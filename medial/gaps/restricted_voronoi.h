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

// Where a piece adjoins another cell within the triangle.
struct CellBorder {
  Index cell = kNone;
  std::uint8_t edges = 0;  // bit i: ends on the triangle's edge i
};

// Where one Voronoi cell meets one triangle.
struct CellPiece {
  Index cell = kNone;               // a point
  std::uint8_t edges = 0;           // bit i: reaches the triangle's edge i along more than a touch
  std::vector<CellBorder> borders;  // longer than a touch, ascending by cell
};

// The Voronoi diagram of points restricted to a surface: every triangle divided among the cells that it lies in. This
// is the intersection of all cell faces with all triangles (dissertation 6.2.4), found from the side of the surface:
// from the cell that holds a corner, on across every border that the polygon of a cell has within the triangle.
// Unbounded faces need no special care and faces away from the surface cost nothing.
class RestrictedVoronoi {
 public:
  // All references must outlive this object. Parallel; the same for any thread count. O(pieces x neighbours of a cell).
  RestrictedVoronoi(const Surface& surface, std::span<const Point> points, const CellNeighbors& neighbors);

  // Divides the triangles again where a `changed` cell has or may have got a part, after `neighbors` was updated;
  // returns these triangles, ascending.
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
