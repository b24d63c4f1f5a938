#pragma once
#include <filesystem>
#include <string>

#include "orchard/voronoi/diagram.h"

namespace orchard {

// The .vor text of a diagram: "voronoi points vertices", a line "p x y z" for each point, then for each vertex "v x y
// z", its forming points and its neighbours, as in VoronoiVertex; -1 stands for the point at infinity
// (docs/reference/formats.md). Numbers are the shortest that read back the same.
std::string to_vor(const VoronoiDiagram& diagram);

// Any system's diagram. Radii are the mean distances to the forming points. Throws InputError, which names file and
// line, or says why the diagram is not consistent (validate()).
VoronoiDiagram read_vor(const std::filesystem::path& file);

}  // namespace orchard
