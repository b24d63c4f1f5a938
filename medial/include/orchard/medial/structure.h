#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "orchard/medial/axis.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard {

// What a part of a medial axis is. The numbers of the first four are those of the structure section that MATStruct
// (Wang et al. 2025) writes into its .ma files, where a border is called a boundary.
enum class StructureKind : std::uint8_t { sheet = 0, seam = 1, border = 2, junction = 3, curve = 4 };
const char* name_of(StructureKind kind);  // "sheet", "seam", ..

// A medial axis taken apart where it branches: sheets of faces that are joined across edges which only two faces
// share; the lines that edges of three or more faces (seams), of one face (borders) and of none (curves) make; and
// junctions, the vertices at which lines end, meet or change their kind, or at which sheets touch in nothing but this
// vertex.
struct MedialStructure {
  struct Part {
    StructureKind kind = StructureKind::sheet;
    Index cells = 0;              // faces of a sheet, edges of a line, 1 for a junction
    std::vector<Index> vertices;  // ascending; those of a sheet and of a line with their ends
  };
  std::vector<Part> parts;       // sheets first, then lines, then junctions, each in the order of their first cell
  std::vector<Index> of_face;    // the sheet of each face
  std::vector<Index> of_edge;    // the line of each edge; kNone inside sheets
  std::vector<Index> of_vertex;  // a junction, or the line, or else the sheet, that the vertex is inside of

  std::size_t count(StructureKind kind) const;
  bool on_curve(Index edge) const;  // whether an edge has no face
};

// Of a whole axis: its walls are faces that follow the others; edges are in the order of (vertex, larger neighbour).
// O(n log n) for n cells.
MedialStructure medial_structure(const MedialAxis& axis);
// Of a medial mesh: faces are its triangles. Precondition: the mesh is complete, as validate() has it.
MedialStructure medial_structure(const MedialMesh& mesh);

// The structure section for the end of the .ma file of the mesh that this is the structure of (medial_mesh.h).
std::string to_structure_section(const MedialStructure& structure);

}  // namespace orchard
