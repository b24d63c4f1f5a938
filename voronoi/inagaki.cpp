#include "orchard/voronoi/inagaki.h"

#include "build.h"

namespace orchard {

VoronoiDiagram inagaki_voronoi(std::span<const Point> points, const Progress& progress, InsertionReport* report) {
  return detail::build_voronoi(points, detail::Search::inagaki, "Voronoi diagram", progress, report);
}

}  // namespace orchard
