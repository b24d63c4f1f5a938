#pragma once
#include "orchard/medial/topology.h"

namespace orchard::detail {

// The least number of vertices of a connected simplicial complex with so many loops and cavities. It follows from the
// theorem of Björner and Kalai ("An extended Euler-Poincaré theorem", 1988), which says which numbers of faces go with
// which Betti numbers. No complex has fewer, and some complex has exactly as many, though not one of every shape. It is
// 1 for a point, 3 for a ring, 4 for a sphere, 4 for two loops (two rings that share an edge).
Index least_vertices(std::int64_t loops, std::int64_t cavities);

// The sum of this over the components of a mesh: no mesh with the same Betti numbers in each component has fewer
// vertices.
Index least_vertices(const MedialMesh& mesh);

}  // namespace orchard::detail
