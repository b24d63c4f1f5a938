#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of the surface that a medial mesh is to reach.
struct FitSample {
  Point position;
  Vector normal;      // outward
  double weight = 0;  // of all of them about 1
};

// `count` places spread evenly over the area, and, as many again at most, where the surface is bent: the corners of the
// mesh, and places along its sharp edges. Deterministic.
std::vector<FitSample> fit_samples(const Surface& surface, Index count, std::uint64_t seed);

}  // namespace orchard::detail
