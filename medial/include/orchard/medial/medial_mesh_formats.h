#pragma once
#include <string>
#include <vector>

#include "orchard/medial/medial_mesh.h"

namespace orchard {

// The same cells with flags by what they are, as MATFP counts features: an edge between balls of radius 0 is external
// (2), on a sharp edge of the surface; one where sheets meet, with other than one or two triangles, internal (1).
FlaggedMedialMesh with_feature_flags(const MedialMesh& mesh);

// PLY as text: vertices with x, y, z and radius, the edges (vertex1, vertex2), and the triangles with their sheet
// (medial_structure()). Numbers are the shortest that read back the same.
std::string to_ply(const MedialMesh& mesh);

// Wavefront OBJ: a group for each sheet's triangles, and one, `wires`, of lines for the edges without triangles. Radii
// are lost.
std::string to_obj(const MedialMesh& mesh);

// GraphML of all edges, those of triangles included: nodes have x, y, z and radius, edges their length and the kind of
// the part that they are in (structure.h). Triangles have no place in it.
std::string to_graphml(const MedialMesh& mesh);

}  // namespace orchard
