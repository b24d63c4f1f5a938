#include "orchard/voronoi/inagaki.h"

#include "algorithms/build.h"

namespace orchard {

VoronoiBuild inagaki_voronoi(std::span<const Point> points, const Progress& progress) {
  return detail::build_voronoi(points, detail::Search::inagaki, "Voronoi diagram", progress);
}

}  // namespace orchard
