#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard {

// A box of an octree, with the triangles that meet it.
struct Octant {
  Box box;
  std::vector<Index> triangles;
  Index node = 0;  // number of the tree's node
};

// Of the eight boxes of half the parent's size, those that meet one of its triangles, or may meet one within rounding.
std::vector<Octant> occupied_children(const Surface& surface, const Octant& parent);

// Divides the parent into `count` occupied boxes. For eight, the result is occupied_children(); else the largest box is
// halved across its longest side until there are `count`.
std::vector<Octant> occupied_parts(const Surface& surface, const Octant& parent, Index count);

}  // namespace orchard
