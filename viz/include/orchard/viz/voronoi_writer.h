#pragma once
#include <filesystem>
#include <optional>
#include <span>

#include "orchard/voronoi/diagram.h"

// Writes Voronoi cells for ParaView.
namespace orchard {

// Which cells are written.
struct VoronoiCellsView {
  // The box that clips the cells; by default a tenth larger than the box of the points.
  std::optional<Box> box;
  std::optional<std::span<const Index>> points;  // The points whose cells are written; by default all.
};

// Writes Voronoi cells as an XML UnstructuredGrid (.vtu) of polyhedra. Each polyhedron has its own corners, so that
// filters like Shrink separate the cells. Cells that do not reach into the box are left out. Cell arrays:
//   point        the point of the cell
//   inaccuracy   cell_inaccuracies() (quality.h), a length
//   faces        the number of faces of the cell in the box
//   at_box       1 if the box cuts the cell
// The file is zlib-compressed and written completely or not at all; the same diagram gives the same bytes. Returns the
// number of cells written. Throws Error if the file cannot be written, and InputError for a point that the diagram does
// not have.
Index write_voronoi_cells(const std::filesystem::path& vtu, const VoronoiDiagram& diagram,
                          const VoronoiCellsView& view = {});

}  // namespace orchard
