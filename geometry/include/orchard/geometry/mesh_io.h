#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// Reads and writes triangle meshes.
namespace orchard {

// What a reader skipped in a file or decided about it. Counts are zero if the file was read without changes.
struct MeshReadReport {
  // The number of times that something occurred, and the place of the first one: "line 7" or "byte 184".
  struct Occurrences {
    Index count = 0;
    std::string first = {};
  };
  Occurrences faces_skipped = {};  // Faces of fewer than three corners.
  // Vertices with a coordinate that is not a finite number, which no face uses.
  Occurrences vertices_skipped = {};
  // Polygons whose outline crosses itself, so that their triangles overlap.
  Occurrences polygons_overlapping = {};
  // Concave polygons and polygons around holes, which a fan of triangles cannot fill.
  Index polygons_triangulated = 0;
  // If the count and the length of a binary .stl file disagree: the facets by its header and the facets found.
  // Otherwise both are zero.
  std::uint64_t facets_promised = 0, facets_found = 0;
  std::uint64_t bytes_left_out = 0;  // Bytes after the last facet of a binary .stl file.
  // Bytes that follow the single facets of a binary .stl file; they are skipped.
  std::uint64_t attribute_bytes = 0;
  Index header_lines = 0;  // Lines before the first point of an .xyz file.

  // Returns whether the mesh contains the whole surface in the file without changes.
  bool complete() const { return faults().empty(); }
  // Returns a line for each kind of fault that keeps complete() from being true.
  std::vector<std::string> faults() const;
  // Returns these lines, and a line for each kind of harmless omission.
  std::vector<std::string> lines() const;
};

// A mesh with the report of its reader.
struct MeshReading {
  TriangleMesh mesh;
  MeshReadReport report;
};

// Reads a mesh. The extension of the file, in upper or lower case, determines the format: .obj and .ply (ASCII, binary
// little- and big-endian) use orchard's own readers, .stl and .off use CGAL.
// - Polygons and strips of triangles (PLY's element "tristrips") become triangles. Polygons that are concave or go
//   around a hole are triangulated by a constrained Delaunay triangulation in their best plane.
// - Properties that orchard does not use are skipped.
// - Identical corners of an .stl file, which stores separate triangles, are welded. Other formats keep their vertices.
// - A face of an .off file may continue over several lines.
// - Faces of fewer than three corners, and vertices without finite coordinates that no face uses, are skipped and
//   counted in the report. Such a vertex keeps its number and gets the place of a used vertex.
// Throws InputError, which names the file, the line or byte, the fault and the remedy, also if the size of the mesh is
// out of range (require_usable_size() in mesh.h). The memory is bounded by the size of the file.
MeshReading read_mesh_and_report(const std::filesystem::path& file);
// Does the same and returns the mesh only.
TriangleMesh read_mesh(const std::filesystem::path& file);

// Reads a file that may contain points only: .obj without faces, .ply without a face element or with an empty one, or
// .xyz. A mesh of points has no triangles, and its vertices do not include points without finite coordinates.
// Coordinates may have any size. Other files are read as by read_mesh_and_report().
// An .xyz file is text with one point on each line: three numbers, separated by blanks, commas or semicolons, and then
// anything. A comment starts with '#', and lines before the first point may be a header.
MeshReading read_points_or_mesh_and_report(const std::filesystem::path& file);
// Does the same and returns the mesh only.
TriangleMesh read_points_or_mesh(const std::filesystem::path& file);

// Writes an .obj file. Every coordinate has the fewest digits (17 at most) that read back as the same double. Throws
// Error if the file cannot be written.
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace orchard
