#pragma once
#include "orchard/medial/medial_mesh.h"

namespace orchard::test {

// How many pieces of a medial mesh hang on the rest by one vertex, could be taken away without a change of topology
// and reach no farther from it than `reach` times its radius, found by walking from every vertex. A piece: triangles
// joined across edges, or a chain of edges without triangles that ends freely.
Index hanging_pieces(const MedialMesh& mesh, double reach);

}  // namespace orchard::test
