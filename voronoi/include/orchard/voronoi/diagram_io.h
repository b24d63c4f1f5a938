#pragma once
#include <filesystem>
#include <string>

#include "orchard/voronoi/diagram.h"

// Reads and writes Voronoi diagrams as .vor files.
namespace orchard {

// Returns the .vor text of a diagram: a line "voronoi points vertices", a line "p x y z" for each point, and for each
// vertex a line "v x y z" with its forming points and its neighbours, in the order of VoronoiVertex. -1 stands for the
// point at infinity. Numbers have the fewest digits that read back as the same value. docs/reference/formats.md
// describes the format.
std::string to_vor(const VoronoiDiagram& diagram);

// Reads a .vor file, which any system may have written. The radius of a vertex is its mean distance to its forming
// points. Throws InputError, which names the file and the line, or states why the diagram is not consistent
// (validate()).
VoronoiDiagram read_vor(const std::filesystem::path& file);

}  // namespace orchard
