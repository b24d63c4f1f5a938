#include "orchard/voronoi/highest_first.h"

#include "algorithms/build.h"

namespace orchard {

VoronoiBuild highest_first_voronoi(std::span<const Point> points, const Progress& progress) {
  return detail::build_voronoi(points, detail::Search::highest_first, "Voronoi diagram", progress);
}

}  // namespace orchard
