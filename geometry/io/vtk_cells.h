#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "cell_mesh.h"

namespace orchard {

// Returns the kind of a type of cell in VTK's numbering (vtkCellType.h); null if the type has no linear corners.
const CellKind* vtk_cell_kind(std::int64_t type);
inline constexpr std::int64_t kVtkPolyhedron = 42;

// The cells of one piece of a VTK file. Cell i has the points connectivity[offsets[i] .. offsets[i + 1]). They are
// counted from vertex `first_point` of the mesh, and the piece has `points` of them.
struct VtkCells {
  std::vector<std::int64_t> offsets{0}, connectivity;
  Index first_point = 0, points = 0;
  std::size_t at = 0;                                         // byte in the file
  std::function<void(std::size_t, const std::string&)> fail;  // reports a fault at a byte; does not return

  std::size_t size() const { return offsets.size() - 1; }
  // Refuses offsets that are not ascending or go beyond the connectivity.
  void check() const;
  // Sets `out` to the points of a cell.
  void corners_of(std::size_t cell, std::vector<Index>& out) const;
  // Returns the point that a cell names, as a vertex of the mesh.
  Index point(std::size_t cell, std::int64_t id) const;
};

// Adds all cells as polygons or strips.
void add_vtk_polygons(const VtkCells& cells, CellShape shape, CellMesh& mesh);
// Adds cells of these types. For polyhedra, `faces` has the number of faces of each, and each face as its number of
// points followed by the points; face_offsets[i] is where cell i ends in `faces`, or -1.
void add_vtk_cells(const VtkCells& cells, std::span<const std::int64_t> types, std::span<const std::int64_t> faces,
                   std::span<const std::int64_t> face_ends, CellMesh& mesh);
// Adds the polyhedron `cell` from the numbers that describe its faces.
void add_vtk_polyhedron(const VtkCells& cells, std::size_t cell, std::span<const std::int64_t> stream, CellMesh& mesh);

}  // namespace orchard
