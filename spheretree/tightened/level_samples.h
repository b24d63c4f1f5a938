#pragma once
#include "orchard/geometry/sampling.h"
#include "partial_tree.h"

namespace orchard::detail {

// Points of the surface that the balls of a level must contain, each with a place where the centre of a ball may start.
struct Samples {
  std::vector<Point> points, starts;
  Index size() const { return static_cast<Index>(points.size()); }
};

// Returns the centre of the largest ball in the solid that touches the surface at a given point, found by shrinking
// from R. `outward` is the direction in which the surface faces there.
Point touching_center(const Surface& surface, const Point& point, const Vector& outward);

// Returns the surface points, each with the centre of the largest ball in the solid that touches it, and the corners of
// the mesh if there are not too many. Points that gap repair added are left out, because they depend on the last digits
// of the others. `surface` is a surface in its frame (canonical_frame.h). Relaxed points are rounded coarsely and moved
// back onto it, so that the same points result if they were sampled in another frame.
Samples surface_samples(const Surface& surface, const SurfaceSampling& sampling);

// Returns about `enough` of them, or a few more: every k-th one, without those that a leaf contains.
Samples samples_for(const Samples& all, const PartialTree& partial, Index enough);

// Returns how many samples are enough for `balls` balls.
Index enough_samples(Index balls);

}  // namespace orchard::detail
