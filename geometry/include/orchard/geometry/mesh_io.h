#pragma once
#include <filesystem>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Reads .obj and .ply (ASCII, binary little- and big-endian) with orchard's own readers, .stl and .off through CGAL; by
// extension, case does not matter. Polygons and strips of triangles (PLY's element "tristrips") become triangles;
// properties that orchard has no use for are skipped. An .stl file is a bag of triangles, so its identical corners are
// welded; other formats keep their vertices as they are. A face of an .off file may go on over several lines.
// Throws InputError naming file, line or byte, fault and remedy, also for meshes whose size is out of range
// (require_usable_size() in mesh.h). Memory is bounded by the size of the file.
TriangleMesh read_mesh(const std::filesystem::path& file);

// The same for files that may hold points alone: .obj without faces, .ply without a face element or with an empty one,
// and .xyz, which is text with a point a line: three numbers, parted by blanks or commas, then anything; '#' begins a
// comment. Then the mesh has no triangles. Coordinates may be of any size.
TriangleMesh read_points_or_mesh(const std::filesystem::path& file);

// Writes .obj; every coordinate in the fewest digits (17 at most) that read back as the same double. Throws Error if
// the file cannot be written.
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace orchard
