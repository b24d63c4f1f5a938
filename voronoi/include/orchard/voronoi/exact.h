#pragma once
#include <span>

#include "orchard/voronoi/voronoi_build.h"

// The exact Voronoi diagram through CGAL, against which the other algorithms are tested.
namespace orchard {

// Builds the Voronoi diagram as the dual of CGAL's Delaunay triangulation, whose predicates are exact. Points that are
// identical to an earlier one form no vertex. If all points lie exactly in one plane, the diagram has no vertices. The
// report contains the dimension and the duplicates alone.
// Throws InputError for coordinates that are not finite. The circumcentres are computed in parallel. The triangulation
// is not, because CGAL's parallel insertion numbers the vertices differently in every run.
VoronoiBuild exact_voronoi(std::span<const Point> points);

}  // namespace orchard
