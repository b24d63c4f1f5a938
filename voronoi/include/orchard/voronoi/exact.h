#pragma once
#include <span>

#include "orchard/voronoi/diagram.h"

namespace orchard {

// The Voronoi diagram as the dual of CGAL's Delaunay triangulation, whose predicates are exact: the oracle of the other
// methods. Coincident points form no vertex. Throws InputError unless the points span three dimensions.
VoronoiDiagram exact_voronoi(std::span<const Point> points);

}  // namespace orchard
