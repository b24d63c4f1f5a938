#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// What a reader left out of a file or had to decide, so that nothing is lost silently. Counts are zero where the file
// was read as it stands.
struct MeshReadReport {
  // How often something occurred, and where it occurred first: "line 7" or "byte 184".
  struct Occurrences {
    Index count = 0;
    std::string first = {};
  };
  Occurrences faces_skipped = {};         // faces of fewer than three corners
  Occurrences vertices_skipped = {};      // vertices with a coordinate that is not a finite number, which no face uses
  Occurrences polygons_overlapping = {};  // polygons whose outline crosses itself, so that their triangles overlap
  Index polygons_triangulated = 0;        // concave polygons and polygons around holes, which no fan of triangles fills
  // Of a binary .stl file whose count and length disagree: facets by its header and facets found; else both are zero.
  std::uint64_t facets_promised = 0, facets_found = 0;
  std::uint64_t bytes_left_out = 0;   // after the last facet of a binary .stl file
  std::uint64_t attribute_bytes = 0;  // that follow the facets of a binary .stl file one by one; they are skipped
  Index header_lines = 0;             // before the first point of an .xyz file

  // Whether everything in the file that makes up its surface is in the mesh, and as the file has it.
  bool complete() const { return faults().empty(); }
  std::vector<std::string> faults() const;  // a line for each kind of thing that keeps complete() from being true
  std::vector<std::string> lines() const;   // the same, and a line for each kind of thing that was skipped harmlessly
};

struct MeshReading {
  TriangleMesh mesh;
  MeshReadReport report;
};

// Reads .obj and .ply (ASCII, binary little- and big-endian) with orchard's own readers, .stl and .off through CGAL; by
// extension, case does not matter. Polygons and strips of triangles (PLY's element "tristrips") become triangles:
// polygons that are concave or go around a hole by a constrained Delaunay triangulation in their best plane. Properties
// that orchard has no use for are skipped. An .stl file is a bag of triangles, so its identical corners are welded;
// other formats keep their vertices as they are. A face of an .off file may go on over several lines. Faces of fewer
// than three corners, and vertices without finite coordinates that no face uses, are skipped and counted in the report;
// such a vertex keeps its number and gets the place of one that is used. Throws InputError naming file, line or byte,
// fault and remedy, also for meshes whose size is out of range (require_usable_size() in mesh.h). Memory is bounded by
// the size of the file.
MeshReading read_mesh_and_report(const std::filesystem::path& file);
TriangleMesh read_mesh(const std::filesystem::path& file);  // the mesh alone

// The same for files that may hold points alone: .obj without faces, .ply without a face element or with an empty one,
// and .xyz, which is text with a point a line: three numbers, parted by blanks, commas or semicolons, then anything;
// '#' begins a comment, and lines before the first point may be a header. Then the mesh has no triangles, and points
// without finite coordinates are not among its vertices. Coordinates may be of any size.
MeshReading read_points_or_mesh_and_report(const std::filesystem::path& file);
TriangleMesh read_points_or_mesh(const std::filesystem::path& file);  // the mesh alone

// Writes .obj; every coordinate in the fewest digits (17 at most) that read back as the same double. Throws Error if
// the file cannot be written.
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace orchard
