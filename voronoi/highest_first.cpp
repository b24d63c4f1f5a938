#include "orchard/voronoi/highest_first.h"

#include "build.h"

namespace orchard {

VoronoiDiagram highest_first_voronoi(std::span<const Point> points, const Progress& progress, InsertionReport* report) {
  return detail::build_voronoi(points, detail::Search::highest_first, "Voronoi diagram", progress, report);
}

}  // namespace orchard
