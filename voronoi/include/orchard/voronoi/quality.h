#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/diagram.h"

namespace orchard {

struct VoronoiInaccuracy {
  double mean = 0, max = 0;   // lengths
  std::uint64_t samples = 0;  // that the mean is over
};

// The dissertation's inaccuracy of a diagram (6.2.3), the mean over samples of how much nearer than the cell's own
// point the nearest point is: d - d'.
//   Corners: all vertices of every cell, but not those at infinity, nor those farther than ten bounding-box diagonals
//   from the box: there the metric measures round-off of the position alone.
//   Samples: at 1/4, 2/4 and 3/4 of the segment from the cell's point to the corner, so three for each point of each
//   vertex that counts. The ends do not count: at the corner itself four distances are equal but for round-off.
// The exact diagram has none, up to round-off of the corners: zero nearly always, since a sample is nearer to its own
// point by more than that. O(log n) a corner on points of surfaces: 100,000 points take a few seconds of processor
// time. These run in parallel, with the same result for any number of threads.
VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram);

// The same with the corners themselves as the only samples: a harder test, which the exact diagram passes only up to
// round-off, about 1e-16 of the diagonal. Up to O(n) a corner where many points are equally far from it, as the centre
// of a sphere is from points on it.
VoronoiInaccuracy corner_inaccuracy(const VoronoiDiagram& diagram);

struct VoronoiInaccuracies {
  VoronoiInaccuracy segments, corners;  // inaccuracy() and corner_inaccuracy()
};

// Both, at the price of one. Throws Cancelled if `progress` says so.
VoronoiInaccuracies inaccuracies(const VoronoiDiagram& diagram, const Progress& progress = {});

// For each point, the mean of inaccuracy() over the samples of its cell alone; 0 for a cell without any.
std::vector<double> cell_inaccuracies(const VoronoiDiagram& diagram);

}  // namespace orchard
