#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/mesh_io.h"

namespace orchard {

// The readers that read_mesh() calls with the bytes of a file. `name` is the name of the file in messages, and `report`
// receives what is left out. Any bytes are allowed: the result passes validate(), or InputError names the line or byte,
// the fault and, if there is one, the remedy. Time and memory are linear in the number of bytes (n log n for read_stl
// and polygons).
TriangleMesh read_obj(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_ply(std::string_view bytes, const std::string& name, MeshReadReport& report);
// Merges identical corners.
TriangleMesh read_stl(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_off(std::string_view bytes, const std::string& name, MeshReadReport& report);
// Meshes for simulations (cell_mesh.h): VTK's XML (.vtp, .vtu) and legacy (.vtk) files, Gmsh's .msh, and Medit's .mesh
// and .meshb. A compressed file may need 1032 times its size of memory.
TriangleMesh read_vtk_xml(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_legacy_vtk(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_gmsh(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_medit(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_binary_medit(std::string_view bytes, const std::string& name, MeshReadReport& report);

// The readers that read_points_or_mesh() calls. They differ in that a file without faces returns its vertices alone,
// and only a file without either is refused. .xyz files have no faces.
TriangleMesh read_obj_or_points(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_ply_or_points(std::string_view bytes, const std::string& name, MeshReadReport& report);
TriangleMesh read_xyz(std::string_view bytes, const std::string& name, MeshReadReport& report);

// Returns all bytes of an existing file. Throws InputError.
std::string read_bytes(const std::filesystem::path& file);

}  // namespace orchard
