#pragma once
#include <span>

#include "orchard/geometry/progress.h"
#include "orchard/voronoi/voronoi_build.h"

// Bowyer's insertion algorithm, for comparison with the robust algorithms.
namespace orchard {

// Builds the Voronoi diagram by Bowyer's insertion in plain double precision: each step deletes the connected vertices
// that are computed to be nearer to the new point. It treats coincident, flat and infinite input as
// highest_first_voronoi() does.
// The algorithm presumes exact arithmetic. It throws Error, which names the point, if rounding leaves no vertex to
// delete, if the deleted vertices do not form a ball, or if a new vertex is wrongly oriented. Nearly all point sets on
// polyhedra cause this. Source: Bowyer 1981; dissertation 6.2.3.
VoronoiBuild bowyer_voronoi(std::span<const Point> points, const Progress& progress = {});

}  // namespace orchard
