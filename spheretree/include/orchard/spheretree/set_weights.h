#pragma once
#include <variant>
#include <vector>

#include "orchard/geometry/mesh.h"

// Weights that make the search for a set of spheres fit some parts of a solid more tightly than others.
namespace orchard {

// A region in which looseness counts `factor` times.
struct WeightRegion {
  std::variant<Box, Sphere> where;
  double factor = 1;  // Above 0; values below 1 make looseness count less.
};

// Where looseness counts more or less in the search for a set of spheres. Weights guide the search and guarantee
// nothing. Where regions overlap, the largest factor counts, and outside all regions the factor is 1. The factors of
// vertices, if given, multiply it, each in the part of space that is nearer to its vertex than to the others. The
// search evaluates the weights on a grid of 48 cells along each side of the solid's bounding box.
struct SetWeights {
  std::vector<WeightRegion> regions{};
  // A factor above 0 for each vertex of the mesh, or none.
  std::vector<double> of_vertices{};
  bool empty() const { return regions.empty() && of_vertices.empty(); }
};

}  // namespace orchard
