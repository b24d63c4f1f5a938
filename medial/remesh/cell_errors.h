#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"
#include "sheet_mesh.h"

namespace orchard::detail {

// Measures how far the balls that cells interpolate are off the exact ones, in mesh units, at a few places of each
// cell. It keeps references to its arguments.
class CellErrors {
 public:
  // `fine`: errors below it do not have to be exact.
  CellErrors(const Surface& surface, const SheetMesh& mesh, double fine)
      : surface_(surface), mesh_(mesh), fine_(fine), cuts_itself_(!surface.self_intersections().empty()) {}

  // Returns the error at the middle of an edge. Errors below `fine` do not have to be exact.
  double of_edge(Index a, Index b, double fine) const { return at({a, b, b}, 0.5, 0.5, 0, fine); }
  double of_edge(Index a, Index b) const { return of_edge(a, b, fine_); }
  // Returns the largest error of some cells, or any error above `enough`.
  double of_cells(std::span<const Index> cells, double enough) const;
  // The same for cells at a vertex, without their sides opposite to it.
  double of_cells_at(std::span<const Index> cells, Index v, double enough);
  // Whether the balls of an edge protrude from the solid by more than `limit`. Such edges run through the outside and
  // are only there to keep the topology.
  bool leads_outside(Index a, Index b, double limit) const;
  // Whether an edge crosses a part of the surface that lies inside the solid, which exists where the surface cuts
  // itself. Distances fall to 0 there, so such an edge has an error however short it is.
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
