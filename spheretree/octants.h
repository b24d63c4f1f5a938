#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard {

// A box of an octree, with the triangles that meet it.
struct Octant {
  Box box;
  std::vector<Index> triangles;
  Index node = 0;  // of the tree
};

// The eight boxes of half the size that meet one of the parent's triangles, or may within rounding.
std::vector<Octant> occupied_children(const Surface& surface, const Octant& parent);

}  // namespace orchard
