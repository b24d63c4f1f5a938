#pragma once
#include <filesystem>
#include <string>

#include "orchard/geometry/mesh.h"
#include "orchard/viz/vtk_writer.h"

// Writes meshes with further arrays for ParaView.
namespace orchard {

// Writes the triangles of a mesh with the given point and cell arrays; the rules of vtk_writer.h hold. If `unit` is not
// empty, it becomes the field data of this name.
void write_mesh_with_arrays(const std::filesystem::path& vtp, const TriangleMesh& mesh, const ViewArrays& of_points,
                            const ViewArrays& of_cells, const std::string& unit = {});

}  // namespace orchard
