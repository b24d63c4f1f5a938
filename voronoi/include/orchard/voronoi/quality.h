#pragma once
#include <cstdint>

#include "orchard/voronoi/diagram.h"

namespace orchard {

struct VoronoiInaccuracy {
  double mean = 0, max = 0;   // lengths
  std::uint64_t samples = 0;  // that the mean is over
};

// The dissertation's inaccuracy of a diagram (6.2.3): at 1/4, 2/4 and 3/4 of the segment from each point to each corner
// of its cell, how much nearer than the cell's own point the nearest point is. Corners at infinity or farther than ten
// bounding-box diagonals from the box are left out: there the metric measures round-off of the position alone.
// O(log n) a sample on points of surfaces. Both run in parallel, with the same result for any number of threads.
VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram);

// The same with the corners themselves as the only samples: a harder test. Up to O(n) a corner where many points are
// equally far from it, as the centre of a sphere is from points on it.
VoronoiInaccuracy corner_inaccuracy(const VoronoiDiagram& diagram);

}  // namespace orchard
