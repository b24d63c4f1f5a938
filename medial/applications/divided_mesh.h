#pragma once
#include <vector>

#include "orchard/medial/thickness.h"

namespace orchard::detail {

// The mesh of a surface, its long edges halved until they are no longer than a length.
struct DividedMesh {
  TriangleMesh mesh;                 // the surface's vertices first, in their order; conforming
  std::vector<Index> of_triangle;    // the surface's triangle that each is a part of; ascending
  std::vector<SurfacePlace> places;  // of the vertices
};

// Linear in the result. Each edge is divided alike in all of its triangles, whatever their order.
DividedMesh divided_mesh(const Surface& surface, double max_edge);

}  // namespace orchard::detail
