#pragma once
#include <span>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

// The insertion algorithm of Inagaki, Sugihara and Sugie, for comparison.
namespace orchard {

// Builds the Voronoi diagram by Inagaki, Sugihara and Sugie's insertion: from the vertex of highest value, a greedy
// breadth-first search finds vertices to delete that keep the five constraints. It works in plain double precision and
// uses only the sign of the values. It treats coincident, flat and infinite input as highest_first_voronoi() does.
// The diagram is consistent for every input, but inaccurate where many points lie on a plane or a sphere: one wrong
// decision misplaces a vertex, which misleads later decisions. Source: Inagaki, Sugihara and Sugie 1992; dissertation
// 6.2.3.
VoronoiBuild inagaki_voronoi(std::span<const Point> points, const Progress& progress = {});

}  // namespace orchard
