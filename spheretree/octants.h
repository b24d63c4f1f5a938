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

// Any number of boxes: for eight, occupied_children(); else the largest box is halved across its longest side until
// `count` occupied ones are there.
std::vector<Octant> occupied_parts(const Surface& surface, const Octant& parent, Index count);

}  // namespace orchard
