#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"

// Reads and writes triangle meshes.
namespace orchard {

// The points that a mesh was made of, and how far they and the mesh are apart, in mesh units (reconstruct.h).
struct PointsReading {
  Index points = 0;
  double spacing = 0;                                // The mean distance between neighbouring points.
  double mean_from_points = 0, max_from_points = 0;  // From the points to the mesh.
  double max_to_points = 0;                          // No place of the mesh is farther from the nearest point: proven.

  void scale_by(double factor) {
    for (double* length : {&spacing, &mean_from_points, &max_from_points, &max_to_points}) *length *= factor;
  }
};

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
  // Of meshes for simulations: the volume cells whose outer surface was taken, and the surface cells beside them, which
  // were skipped; lines and points; cells with more nodes than corners, which were read as flat.
  Index volume_cells = 0, cells_beside = 0, lines_skipped = 0, curved_cells = 0;
  std::string unit = {};  // The unit of the mesh, such as "mm", if the file or the user names it.
  double scale = 1;       // The factor by which the coordinates of the file were multiplied.
  std::optional<PointsReading> from_points = {};  // Of a mesh that was made of points.

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

// Reads a mesh. `format`, or if it is empty the extension of the file, in upper or lower case, determines the format:
// obj, ply (ASCII, binary little- and big-endian), stl, off, VTK's vtp, vtu and vtk (legacy), Gmsh's msh (versions 2
// and 4, text and binary), and Medit's mesh and meshb.
// - Polygons and strips of triangles (PLY's element "tristrips") become triangles. Polygons that are concave or go
//   around a hole are triangulated by a constrained Delaunay triangulation in their best plane.
// - Properties that orchard does not use are skipped.
// - Files of volume cells (vtu, vtk, msh, mesh) give their outer surface: the faces that belong to one volume cell. A
//   border between two volumes is none. Surface cells are read where there are no volume cells, else skipped. Of curved
//   cells, the corners are read. Pieces of a file become one mesh.
// - Identical corners of an .stl file, which stores separate triangles, are welded. Other formats keep their vertices.
// - A face of an .off file may continue over several lines.
// - Faces of fewer than three corners, and vertices without finite coordinates that no face uses, are skipped and
//   counted in the report. Such a vertex keeps its number and gets the place of a used vertex.
// Throws InputError, which names the file, the line or byte, the fault and the remedy, also if the size of the mesh is
// out of range (require_usable_size() in mesh.h). The memory is bounded by the size of the file, and by 1032 times that
// size where it is compressed.
MeshReading read_mesh_and_report(const std::filesystem::path& file, const std::string& format = {});
// Does the same and returns the mesh only.
TriangleMesh read_mesh(const std::filesystem::path& file);

// Reads a file that may contain points only: .obj without faces, .ply without a face element or with an empty one, or
// .xyz. A mesh of points has no triangles, and its vertices do not include points without finite coordinates.
// Coordinates may have any size. Other files are read as by read_mesh_and_report().
// An .xyz file is text with one point on each line: three numbers, separated by blanks, commas or semicolons, and then
// anything. A comment starts with '#', and lines before the first point may be a header.
MeshReading read_points_or_mesh_and_report(const std::filesystem::path& file, const std::string& format = {});
// Does the same and returns the mesh only.
TriangleMesh read_points_or_mesh(const std::filesystem::path& file);

// Returns the names of the formats that read_mesh() reads, in lower case without a dot.
std::vector<std::string> mesh_formats();

// Writes an .obj file. Every coordinate has the fewest digits (17 at most) that read back as the same double. Throws
// Error if the file cannot be written.
void write_obj(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace orchard
