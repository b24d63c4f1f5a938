#pragma once
#include <vector>

#include "orchard/medial/surface_parts.h"

namespace orchard::detail {

// The regions of an axis between significant necks.
struct RadiusRegions {
  std::vector<Index> of_vertex;
  Index count = 0;
  std::vector<SurfaceParts::Neck> necks;  // the most significant first
};

// Finds the regions of a complete mesh. `significance` is PartOptions::neck. Regions are numbered by the radius of
// their largest ball, from large to small. O(n log n).
RadiusRegions radius_regions(const MedialMesh& mesh, double significance);

}  // namespace orchard::detail
