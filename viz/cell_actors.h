#pragma once
#include <vtkUnstructuredGrid.h>

#include <array>
#include <optional>

#include "actors.h"

// Voronoi cells, as write_voronoi_cells() writes them.
namespace orchard::detail {

using Backward = std::optional<std::array<double, 3>>;

// Whether cells are more inaccurate than rounding makes them.
bool is_inaccurate(vtkUnstructuredGrid* grid);

// The polyhedra of the half that is away from the eye, or all of them, drawn apart: each in a colour of its own, or by
// inaccuracy where there is any.
vtkSmartPointer<vtkActor> make_cells(vtkUnstructuredGrid* grid, const Backward& backward, double line_width);

}  // namespace orchard::detail
