#pragma once
#include <span>

#include "orchard/voronoi/voronoi_build.h"

namespace orchard {

// The Voronoi diagram as the dual of CGAL's Delaunay triangulation, whose predicates are exact: the oracle of the other
// algorithms. Points identical to an earlier one form no vertex. Points that all lie in a plane, exactly, have a
// diagram without vertices. Of the report only the dimension and the duplicates are filled in. The circumcentres are
// computed in parallel; the triangulation is not, since CGAL's parallel insertion numbers the vertices differently in
// every run. Throws InputError for coordinates that are not finite.
VoronoiBuild exact_voronoi(std::span<const Point> points);

}  // namespace orchard
