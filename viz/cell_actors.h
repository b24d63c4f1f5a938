#pragma once
#include <vtkUnstructuredGrid.h>

#include <array>
#include <optional>

#include "actors.h"

// Draws Voronoi cells that write_voronoi_cells() has written.
namespace orchard::detail {

using Backward = std::optional<std::array<double, 3>>;

// Whether cells are more inaccurate than rounding makes them.
bool is_inaccurate(vtkUnstructuredGrid* grid);

// Draws the polyhedra of the half that is away from the eye, or all of them, with gaps between them. Each has a colour
// of its own, or the colours show the inaccuracy if there is any.
vtkSmartPointer<vtkActor> make_cells(vtkUnstructuredGrid* grid, const Backward& backward, double line_width);

}  // namespace orchard::detail
