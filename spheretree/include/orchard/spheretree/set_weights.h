#pragma once
#include <variant>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// A region in which looseness counts `factor` times.
struct WeightRegion {
  std::variant<Box, Sphere> where;
  double factor = 1;  // above 0; below 1 counts less
};

// Where looseness counts more or less when a set of spheres is searched; it promises nothing. Where regions meet, the
// largest factor counts, and elsewhere 1; the factors of vertices, if given, multiply it, each in the part of space
// that is nearer to its vertex than to others. The search sees this on a grid of 48 cells along each side of the
// solid's bounding box.
struct SetWeights {
  std::vector<WeightRegion> regions{};
  std::vector<double> of_vertices{};  // one for each vertex of the mesh, above 0; or none
  bool empty() const { return regions.empty() && of_vertices.empty(); }
};

}  // namespace orchard
