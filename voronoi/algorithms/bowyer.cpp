#include "orchard/voronoi/bowyer.h"

#include "algorithms/build.h"

namespace orchard {

VoronoiBuild bowyer_voronoi(std::span<const Point> points, const Progress& progress) {
  return detail::build_voronoi(points, detail::Search::bowyer, "Voronoi diagram", progress);
}

}  // namespace orchard
