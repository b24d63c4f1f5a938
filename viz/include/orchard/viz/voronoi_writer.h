#pragma once
#include <filesystem>
#include <optional>
#include <span>

#include "orchard/voronoi/diagram.h"

namespace orchard {

struct VoronoiCellsView {
  std::optional<Box> box;                        // clips the cells; a tenth larger than the points' box unless given
  std::optional<std::span<const Index>> points;  // whose cells; all unless given
};

// Voronoi cells as ParaView opens them: XML UnstructuredGrid (.vtu) of polyhedra, each with corners of its own, so that
// filters like Shrink part them. Cells that do not reach into the box are left out. Cell arrays:
//   point        the cell's
//   inaccuracy   cell_inaccuracies() (quality.h), a length
//   faces        that the cell has in the box
//   at_box       1 if the box cuts the cell
// Zlib-compressed; the same bytes for the same diagram. The file appears as a whole or not at all; throws Error if it
// cannot be written, InputError for a point that the diagram does not have. Returns the number of cells written.
Index write_voronoi_cells(const std::filesystem::path& vtu, const VoronoiDiagram& diagram,
                          const VoronoiCellsView& view = {});

}  // namespace orchard
