#pragma once
#include <string>
#include <vector>

#include "orchard/medial/contacts.h"
#include "orchard/medial/medial_mesh.h"

// Writes medial meshes in formats that other programs read.
namespace orchard {

// Returns the same cells with flags by their kind, as MATFP counts features. An edge between balls of radius 0 lies on
// a sharp edge of the surface and is external (2). An edge where sheets meet, with a number of triangles other than one
// or two, is internal (1).
FlaggedMedialMesh with_feature_flags(const MedialMesh& mesh);

// Returns a text PLY file: vertices with x, y, z and radius, edges (vertex1, vertex2), and triangles with the number of
// their sheet (medial_structure()). With `contacts`, it also has the elements contact (ball, sample) and sample (x, y,
// z, ball; -1 for none). Numbers have the fewest digits that read back as the same value.
std::string to_ply(const MedialMesh& mesh, const AxisContacts* contacts = nullptr);

// Returns a Wavefront OBJ file: a group for the triangles of each sheet, and a group `curves` of lines for the edges
// without triangles. The file does not contain the radii.
std::string to_obj(const MedialMesh& mesh);

// Returns a GraphML file of all edges, those of triangles included. Nodes have x, y, z and radius; edges have their
// length and the kind of the part that contains them (structure.h). The file does not contain triangles.
std::string to_graphml(const MedialMesh& mesh);

}  // namespace orchard
