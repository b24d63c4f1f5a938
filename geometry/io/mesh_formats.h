#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/mesh_io.h"

namespace orchard {

// The readers behind read_mesh(), on a file's bytes. `name` is what messages call the file; `report` receives what is
// left out. Any bytes will do: the result passes validate(), or InputError names the line or byte, the fault and, where
// there is one, the remedy. Time and memory grow linearly with the bytes (read_stl and polygons: n log n).
TriangleMesh read_obj(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_ply(std::string_view bytes, const std::string& name, MeshReadReport& report);
// Welds identical corners.
TriangleMesh read_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_off(std::string_view bytes, const std::string& name, MeshReadReport& report);
// Meshes for simulations (cell_mesh.h): VTK's XML (.vtp, .vtu) and legacy (.vtk) files, Gmsh's .msh, and Medit's .mesh
// and .meshb. A compressed file may take 1032 times its size of memory.
TriangleMesh read_vtk_xml(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_legacy_vtk(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_gmsh(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_medit(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_binary_medit(std::string_view bytes, const std::string& name, MeshReadReport& report);

// The readers behind read_points_or_mesh(). The same, but a file without faces gives its vertices alone; only one
// without either is refused. .xyz has no faces.
TriangleMesh read_obj_or_points(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_ply_or_points(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_xyz(std::string_view bytes, const std::string& name, MeshReadReport& report);

// All bytes of a file that is there. Throws InputError.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace orchard
