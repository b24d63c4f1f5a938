#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cell_mesh.h"

namespace orchard {

// What VTK numbers as a type of cell (vtkCellType.h); null if it has no linear corners here.
const CellKind* vtk_cell_kind(std::int64_t type);
inline constexpr std::int64_t kVtkPolyhedron = 42;

// Cells of one piece of a VTK file: cell i has the points connectivity[offsets[i] .. offsets[i + 1]), counted from
// `first_point` of the mesh, of which the piece has `points`.
struct VtkCells {
  std::vector<std::int64_t> offsets{0}, connectivity;
  Index first_point = 0, points = 0;
  std::size_t at = 0;                                         // byte in the file
  std::function<void(std::size_t, const std::string&)> fail;  // reports a fault at a byte; does not return

  std::size_t size() const { return offsets.size() - 1; }
  // Refuses offsets that do not ascend or go beyond the connectivity.
  void check() const;
  // The points of a cell, in `out`.
  void corners_of(std::size_t cell, std::vector<Index>& out) const;
  // The point that a cell names, as a vertex of the mesh.
  Index point(std::size_t cell, std::int64_t id) const;
};

// Adds all cells as polygons or strips.
void add_vtk_polygons(const VtkCells& cells, CellShape shape, CellMesh& mesh);
// Adds cells of these types. `faces`, of polyhedra: for each its number of faces, and each face as its number of points
// and these; face_offsets[i]: where in `faces` cell i ends, or -1.
void add_vtk_cells(const VtkCells& cells, std::span<const std::int64_t> types, std::span<const std::int64_t> faces,
                   std::span<const std::int64_t> face_ends, CellMesh& mesh);
// Adds the polyhedron `cell` from the numbers that describe its faces.
void add_vtk_polyhedron(const VtkCells& cells, std::size_t cell, std::span<const std::int64_t> stream, CellMesh& mesh);

}  // namespace orchard
