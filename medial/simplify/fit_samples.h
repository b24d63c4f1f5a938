#pragma once
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// A place of the surface that should lie on the envelope of a medial mesh, or a place inside the solid that should be
// as deep in the reconstruction.
struct FitSample {
  Point position;
  Vector normal;      // outward
  double weight = 0;  // the weights of all samples add up to about 1
  double depth = 0;   // in the solid, mesh units; 0 on the surface
  double area = 0;    // the share of the surface's area that it represents; 0 for samples that were added later
};

// Returns `count` places spread evenly over the area, and at most as many more where the surface is bent: corners of
// the mesh, and places along its sharp edges. Deterministic.
std::vector<FitSample> fit_samples(const Surface& surface, Index count, std::uint64_t seed);

}  // namespace orchard::detail
