#pragma once
#include <span>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

namespace orchard {

// The Voronoi diagram by Bowyer's insertion (1981; dissertation 6.2.3) in plain double precision: every connected
// vertex that computes as nearer to the new point is deleted. It presumes exact arithmetic: throws Error, naming the
// point, where rounding leaves nothing to delete, makes what is deleted other than a ball or a new vertex wrongly
// oriented. Nearly all points of polyhedra do. Coincident, flat and infinite input as highest_first_voronoi.
VoronoiBuild bowyer_voronoi(std::span<const Point> points, const Progress& progress = {});

}  // namespace orchard
