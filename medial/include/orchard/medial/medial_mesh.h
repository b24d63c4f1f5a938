#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/medial/axis.h"

// Medial meshes: balls joined by edges and triangles, and their .ma files.
namespace orchard {

// A medial axis as balls, and edges and triangles between them. An edge or triangle stands for the balls in between,
// whose centres and radii are interpolated linearly. Any system's result has this form. Source: Q-MAT, Li et al. 2015.
struct MedialMesh {
  std::vector<Point> centers;
  std::vector<double> radii;  // At least 0, in mesh units.
  // The edges, each with ascending vertices and only once, those of the triangles included.
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::array<Index, 3>> triangles;  // Each with ascending vertices and only once.

  Index size() const { return static_cast<Index>(centers.size()); }
};

// Returns the whole axis as a medial mesh, topology faces included, so that the result has the topology of the axis.
// Faces are cut into fans from a corner whose diagonals are not yet edges, or from a new vertex at the middle of the
// face if there is no such corner.
MedialMesh medial_mesh(const MedialAxis& axis);

// Sorts edges and triangles, removes repeated ones and adds the edges of triangles.
void complete(MedialMesh& mesh);

// Throws InputError, which names the first fault, unless the mesh has a vertex and is complete, indices are in range,
// corners are distinct, coordinates are finite, and radii are finite and not negative.
void validate(const MedialMesh& mesh);

// The flags of a cell in a .ma file of MATFP (Wang et al. 2022).
struct CellFlags {
  // For an edge: 1 internal, 2 external feature, 0 neither. For a vertex: the kind of its ball.
  int type = 0;
  // Whether the cell is present only so that the other cells keep their numbers. Such a cell does not count.
  bool deleted = false;
  bool operator==(const CellFlags&) const = default;
};

// A part of an axis in the structure section of a .ma file of MATStruct (Wang et al. 2025).
struct StructurePart {
  Index number = 0;  // The name of the part in the file.
  // 0 sheet, 1 seam, 2 border (called boundary there), 3 junction, and 4 curve, which only orchard writes.
  Index kind = 0;
  // The triangles of a sheet, the edges of a line or the vertex of a junction; ascending.
  std::vector<Index> cells;
  bool operator==(const StructurePart&) const = default;
};

// A .ma file with all its cells, deleted ones included. There is one flag for each cell of `mesh`, or there are none.
struct FlaggedMedialMesh {
  MedialMesh mesh;
  std::vector<CellFlags> vertices = {}, edges = {}, triangles = {};
  std::vector<StructurePart> structure = {};
  // The number of tetrahedra that a file of MATTopo lists and does not delete. `mesh` has only their triangles.
  Index tetrahedra = 0;
};

// Returns the cells that are not deleted and have no deleted cell on their boundary. Vertices are renumbered in their
// order. Precondition: vectors of flags are empty or as long as their cells. Throws InputError if no vertex is left.
MedialMesh without_deleted(const FlaggedMedialMesh& flagged);

// Returns the .ma text of a medial mesh: a line "nv ne nf", then lines "v x y z r", "e i j" and "f i j k" with indices
// from 0. Each of these lines may end with flags (docs/reference/formats.md). Numbers have the fewest digits that read
// back as the same value. Flags are written where there are any, in the columns that MATFP reads; the column of deleted
// edges or triangles is written only if one is deleted.
std::string to_ma(const MedialMesh& mesh);
std::string to_ma(const FlaggedMedialMesh& flagged);
// Returns the structure section for the end of a .ma file, as MATStruct reads it: a line with the number of parts, then
// for each part a line "number kind n cells..". Programs that read a .ma file by its numbers of cells do not see the
// section.
std::string to_structure_section(const std::vector<StructurePart>& parts);
// Reads a .ma file. The result is complete and valid; edges that only deleted triangles have are deleted. read_ma()
// returns only the cells that count, and read_flagged_ma() returns all.
// The readers skip lines that start with '#' and text after the needed numbers of a line, unless it is flags. They also
// skip what MATTopo's .ma_dup files have in addition: a fourth number in the first line and the "t" lines that it
// counts, importances of triangles, and numbers of copies. They read a structure section if there is one. Throws
// InputError, which names the file and the line.
MedialMesh read_ma(const std::filesystem::path& file);
FlaggedMedialMesh read_flagged_ma(const std::filesystem::path& file);

}  // namespace orchard
