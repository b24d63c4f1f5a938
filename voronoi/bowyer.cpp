#include "orchard/voronoi/bowyer.h"

#include "build.h"

namespace orchard {

VoronoiDiagram bowyer_voronoi(std::span<const Point> points, const Progress& progress, InsertionReport* report) {
  return detail::build_voronoi(points, detail::Search::bowyer, "Voronoi diagram", progress, report);
}

}  // namespace orchard
