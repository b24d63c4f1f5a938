#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of the surface that the envelope of a medial mesh is to end at, or one inside the solid that is to be as deep
// in the reconstruction.
struct FitSample {
  Point position;
  Vector normal;      // outward
  double weight = 0;  // of all of them about 1
  double depth = 0;   // in the solid, mesh units; 0 on the surface
  double area = 0;    // of the surface's, that it stands for: of all of them 1, of those that were added nothing
};

// `count` places spread evenly over the area, and, as many again at most, where the surface is bent: the corners of the
// mesh, and places along its sharp edges. Deterministic.
std::vector<FitSample> fit_samples(const Surface& surface, Index count, std::uint64_t seed);

}  // namespace orchard::detail
