#pragma once
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/medial/axis.h"

namespace orchard {

// A medial axis as the medial-mesh community has it (Q-MAT, Li et al. 2015): balls, and edges and triangles between
// them that stand for the balls in between, whose centres and radii are interpolated linearly. Any system's result.
struct MedialMesh {
  std::vector<Point> centers;
  std::vector<double> radii;                    // >= 0
  std::vector<std::array<Index, 2>> edges;      // ascending, each once; those of the triangles included
  std::vector<std::array<Index, 3>> triangles;  // each ascending, each once

  Index size() const { return static_cast<Index>(centers.size()); }
};

// The whole axis, walls included, so that the result has its topology. Faces are cut into fans from a corner whose
// diagonals are no edges yet, or from a new vertex at the face's middle where there is no such corner.
MedialMesh medial_mesh(const MedialAxis& axis);

// Sorts edges and triangles, drops repeated ones and adds the edges of triangles.
void complete(MedialMesh& mesh);

// Throws InputError, which names the first fault, unless the mesh is complete, indices are in range, corners distinct,
// coordinates finite and radii finite and not negative, and there is a vertex.
void validate(const MedialMesh& mesh);

// What a .ma file of MATFP (Wang et al. 2022) says about a cell.
struct CellFlags {
  int type = 0;          // of an edge: 1 internal, 2 external feature, 0 neither; of a vertex: the kind of its ball
  bool deleted = false;  // there so that others keep their numbers; it does not count
  bool operator==(const CellFlags&) const = default;
};

// A part of an axis in the structure section of a .ma file of MATStruct (Wang et al. 2025).
struct StructurePart {
  Index number = 0;          // its name in the file
  Index kind = 0;            // 0 sheet, 1 seam, 2 border (there: boundary), 3 junction; 4 curve, which orchard adds
  std::vector<Index> cells;  // triangles of a sheet, edges of a line, the vertex of a junction; ascending
  bool operator==(const StructurePart&) const = default;
};

// A .ma file as it is, deleted cells included. Flags belong to the cells of `mesh` one by one, or there are none.
struct FlaggedMedialMesh {
  MedialMesh mesh;
  std::vector<CellFlags> vertices = {}, edges = {}, triangles = {};
  std::vector<StructurePart> structure = {};
  Index tetrahedra = 0;  // that a file of MATTopo lists and does not delete; `mesh` has their triangles alone
};

// The cells that count, vertices renumbered in their order: those that are not deleted, nor part of whose boundary
// is. Precondition: vectors of flags are empty or as long as their cells. Throws InputError if no vertex is left.
MedialMesh without_deleted(const FlaggedMedialMesh& flagged);

// The .ma format: a line "nv ne nf", then lines "v x y z r", "e i j" and "f i j k", counted from 0, each of which may
// end with flags (docs/reference/formats.md). Numbers are the shortest that read back the same. Flags are written where
// there are any, in the columns that MATFP reads; the column of deleted edges or triangles only if one is.
std::string to_ma(const MedialMesh& mesh);
std::string to_ma(const FlaggedMedialMesh& flagged);
// The structure section for the end of a .ma file, as MATStruct reads it: a line with the number of parts, then for
// each a line "number kind n cells..". Programs that read a .ma file by its numbers of cells do not see it.
std::string to_structure_section(const std::vector<StructurePart>& parts);
// Lines that start with '#' and text after what is needed on a line, unless it is flags, are skipped. The result is
// complete (edges that only deleted triangles have are deleted) and valid; read_ma() gives the cells that count alone.
// The columns that MATTopo's .ma_dup files have more are read over: a fourth number in the first line and the "t" lines
// that it counts, importances of triangles, and numbers of copies. A structure section is read if there is one.
// Throws InputError, which names file and line.
MedialMesh read_ma(const std::filesystem::path& file);
FlaggedMedialMesh read_flagged_ma(const std::filesystem::path& file);

}  // namespace orchard
