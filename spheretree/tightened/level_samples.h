#pragma once
#include "orchard/medial/axis.h"
#include "partial_tree.h"

namespace orchard::detail {

// Points of the surface that a level's balls must hold, each with a start for the centre of a ball near it.
struct Samples {
  std::vector<Point> points, starts;
  Index size() const { return static_cast<Index>(points.size()); }
};

// The axis's surface points, each with the centre of the largest medial ball that touches it, and the mesh's corners if
// they are not too many.
Samples surface_samples(const Surface& surface, const MedialAxis& axis);

// Enough of them for so many balls: every k-th, without those that a leaf holds.
Samples samples_for(const Samples& all, const PartialTree& partial, Index balls);

}  // namespace orchard::detail
