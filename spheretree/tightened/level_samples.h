#pragma once
#include "orchard/geometry/sampling.h"
#include "partial_tree.h"

namespace orchard::detail {

// Points of the surface that a level's balls must hold, each with a start for the centre of a ball near it.
struct Samples {
  std::vector<Point> points, starts;
  Index size() const { return static_cast<Index>(points.size()); }
};

// The centre of the largest ball in the solid that touches the surface at a point of it, shrunk from R; `outward`:
// where the surface faces there.
Point touching_center(const Surface& surface, const Point& point, const Vector& outward);

// The surface points but for those that gap repair added, which come out otherwise with the last digits of the others:
// each with the centre of the largest ball in the solid that touches it; and the mesh's corners if they are not too
// many. `surface` is one in its frame (canonical_frame.h). Relaxed points are taken roughly and put back on it, so that
// the same come out where they were sampled in another frame.
Samples surface_samples(const Surface& surface, const SurfaceSampling& sampling);

// About so many of them, or a few more: every k-th, without those that a leaf holds.
Samples samples_for(const Samples& all, const PartialTree& partial, Index enough);

// How many are enough for so many balls.
Index enough_samples(Index balls);

}  // namespace orchard::detail
