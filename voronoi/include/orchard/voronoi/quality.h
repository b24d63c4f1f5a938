#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/diagram.h"

// Measures how inaccurate the positions of a Voronoi diagram are.
namespace orchard {

// The inaccuracy of a diagram.
struct VoronoiInaccuracy {
  double mean = 0, max = 0;   // Lengths in mesh units.
  std::uint64_t samples = 0;  // The number of samples that the mean is taken over.
};

// Measures the dissertation's inaccuracy of a diagram: the mean over samples of d - d', where d is the distance of a
// sample to its cell's own point and d' that to the nearest point.
// - Corners are all vertices of every cell, except those at infinity and those farther than ten bounding-box diagonals
//   from the box, where the metric measures round-off of the position alone.
// - Samples lie at 1/4, 2/4 and 3/4 of the segment from the cell's point to each corner. The ends are not sampled: at
//   the corner itself four distances are equal up to round-off.
// The exact diagram has an inaccuracy of zero nearly always, since a sample is nearer to its own point by more than the
// round-off of the corners. The work is parallel, with the same result for any number of threads. Takes O(log n) for
// each corner on surface points; 100,000 points take a few seconds of processor time. Source: dissertation 6.2.3.
VoronoiInaccuracy inaccuracy(const VoronoiDiagram& diagram);

// Measures the same with the corners themselves as the only samples. This is a harder test, which the exact diagram
// passes up to round-off only, about 1e-16 of the diagonal. Takes up to O(n) for a corner that is equally far from many
// points, such as the centre of a sphere from points on it.
VoronoiInaccuracy corner_inaccuracy(const VoronoiDiagram& diagram);

// The results of both measures.
struct VoronoiInaccuracies {
  VoronoiInaccuracy segments, corners;  // inaccuracy() and corner_inaccuracy().
};

// Measures both at the cost of one. Throws Cancelled if `progress` returns false.
VoronoiInaccuracies inaccuracies(const VoronoiDiagram& diagram, const Progress& progress = {});

// Returns, for each point, the mean of inaccuracy() over the samples of its cell; 0 for a cell without samples.
std::vector<double> cell_inaccuracies(const VoronoiDiagram& diagram);

}  // namespace orchard
