#pragma once
#include <span>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

namespace orchard {

// The Voronoi diagram by Inagaki, Sugihara and Sugie's insertion (1992; dissertation 6.2.3): a greedy breadth-first
// search, from the vertex of highest value, for vertices to delete that keep the five constraints. In plain double
// precision, whatever the values say beyond their sign. Consistent for every input, but inaccurate where many points
// lie on a plane or a sphere: one wrong decision misplaces a vertex, which misleads later ones. Kept to compare with.
// Coincident, flat and infinite input as highest_first_voronoi.
VoronoiBuild inagaki_voronoi(std::span<const Point> points, const Progress& progress = {});

}  // namespace orchard
