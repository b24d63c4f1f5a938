#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "orchard/medial/axis.h"
#include "orchard/medial/medial_mesh.h"

// Divides a medial axis into sheets, lines and junctions.
namespace orchard {

// The kind of a part of a medial axis. The first four have the numbers of the structure section that MATStruct (Wang et
// al. 2025) writes into its .ma files, where a border is called a boundary.
enum class StructureKind : std::uint8_t { sheet = 0, seam = 1, border = 2, junction = 3, curve = 4 };
const char* name_of(StructureKind kind);  // Returns "sheet", "seam", ..

// The parts of a medial axis between the places where it branches:
// - sheets of faces that are joined across edges with exactly two faces;
// - lines: seams of edges with at least three faces, borders of edges with one face, and curves of edges with none;
// - junctions: vertices at which lines end, meet or change their kind, or at which sheets touch in this vertex only.
struct MedialStructure {
  struct Part {
    StructureKind kind = StructureKind::sheet;
    Index cells = 0;              // The number of faces of a sheet or of edges of a line; 1 for a junction.
    std::vector<Index> vertices;  // Ascending; a sheet and a line include their ends.
  };
  // Sheets come first, then lines, then junctions, each in the order of their first cell.
  std::vector<Part> parts;
  std::vector<Index> of_face;  // The sheet of each face.
  std::vector<Index> of_edge;  // The line of each edge; kNone inside sheets.
  // The part of each vertex: its junction, or else the line or the sheet in whose interior it lies.
  std::vector<Index> of_vertex;

  std::size_t count(StructureKind kind) const;
  bool on_curve(Index edge) const;  // Returns whether an edge has no face.
};

// Divides a whole axis. Its topology faces are numbered as faces after the others. Edges are in the order of (vertex,
// larger neighbour). O(n log n) for n cells.
MedialStructure medial_structure(const MedialAxis& axis);
// Divides a medial mesh, whose faces are its triangles. Precondition: the mesh is complete as validate() requires.
MedialStructure medial_structure(const MedialMesh& mesh);

// Returns the structure section for the end of the .ma file of the mesh with this structure (medial_mesh.h).
std::string to_structure_section(const MedialStructure& structure);

}  // namespace orchard
