#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "sheet_mesh.h"

namespace orchard::detail {

// How far the balls that cells interpolate are off the exact ones, mesh units, at a few places of each cell. Keeps
// references to what it is made of.
class CellErrors {
 public:
  // `fine`: errors below it need not be told apart.
  CellErrors(const Surface& surface, const SheetMesh& mesh, double fine)
      : surface_(surface), mesh_(mesh), fine_(fine), cuts_itself_(!surface.self_intersections().empty()) {}

  // At the middle of an edge; errors below `fine` need not be told apart.
  double of_edge(Index a, Index b, double fine) const { return at({a, b, b}, 0.5, 0.5, 0, fine); }
  double of_edge(Index a, Index b) const { return of_edge(a, b, fine_); }
  // The largest of some cells; once it is more than `enough`, that will do.
  double of_cells(std::span<const Index> cells, double enough) const;
  // The same of these cells at a vertex, without their sides that are not at it.
  double of_cells_at(std::span<const Index> cells, Index v, double enough);
  // Whether the balls of an edge stick out of the solid by more than `limit`: such edges lead through the outside, for
  // the sake of the topology alone.
  bool leads_outside(Index a, Index b, double limit) const;
  // Whether an edge goes through a part of the surface that lies inside the solid, as there is where the surface cuts
  // itself: distances fall to 0 there, so the edge is wrong however short it is.
  bool crosses_surface(Index a, Index b) const;

 private:
  double at(const SheetMesh::Cell& cell, double u, double v, double w, double fine) const;
  double of_cell(const SheetMesh::Cell& cell) const;

  const Surface& surface_;
  const SheetMesh& mesh_;
  const double fine_;
  const bool cuts_itself_;
  std::vector<Index> ends_;
};

}  // namespace orchard::detail
