#pragma once
#include <cstdint>

#include "orchard/voronoi/diagram.h"

namespace orchard {

struct VoronoiInaccuracy {
  double mean = 0, max = 0;                // lengths, over the samples
  std::uint64_t samples = 0;               // three for each pair of a point and a corner of its cell
  double corner_mean = 0, corner_max = 0;  // the same at the corners themselves: a harder test than the dissertation's
};

// The dissertation's inaccuracy of a diagram (6.2.3): at 1/4, 2/4 and 3/4 of the segment from each point to each corner
// of its cell, how much nearer than the cell's own point the nearest point is. Corners at infinity or farther than ten
// bounding-box diagonals from the box are left out: there the metric measures round-off of the position alone.
// Parallel; O(log n) a sample on points of surfaces. The same result with any number of threads.
VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram);

}  // namespace orchard
