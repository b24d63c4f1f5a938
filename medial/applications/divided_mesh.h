#pragma once
#include <vector>

#include "orchard/medial/thickness.h"

namespace orchard::detail {

// The mesh of a surface after all edges longer than a given length have been halved, until none is longer.
struct DividedMesh {
  TriangleMesh mesh;                 // the surface's vertices first, in their order; conforming
  std::vector<Index> of_triangle;    // the surface's triangle that each is a part of; ascending
  std::vector<SurfacePlace> places;  // of the vertices
};

// Takes time linear in the size of the result. An edge is divided in the same way in all triangles that share it, in
// whatever order they are visited.
DividedMesh divided_mesh(const Surface& surface, double max_edge);

}  // namespace orchard::detail
