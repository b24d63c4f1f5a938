#pragma once
#include "orchard/medial/topology.h"

namespace orchard::detail {

// The least number of vertices of a connected simplicial complex with so many loops and cavities, by Björner and Kalai
// ("An extended Euler-Poincaré theorem", 1988), who say which numbers of faces go with which Betti numbers: proved, and
// some complex has no more, though not one of every shape. A point has 1, a ring 3, a sphere 4, two rings 4.
Index least_vertices(std::int64_t loops, std::int64_t cavities);

// The same for all components of a mesh together: none with the Betti numbers of each has fewer.
Index least_vertices(const MedialMesh& mesh);

}  // namespace orchard::detail
