#pragma once
#include <filesystem>
#include <string>

#include "orchard/geometry/mesh.h"
#include "orchard/viz/vtk_writer.h"

namespace orchard {

// Triangles with point and cell arrays of one's own, in the manner of vtk_writer.h. `unit` is the field data of this
// name unless it is empty.
void write_mesh_with_arrays(const std::filesystem::path& vtp, const TriangleMesh& mesh, const ViewArrays& of_points,
                            const ViewArrays& of_cells, const std::string& unit = {});

}  // namespace orchard
