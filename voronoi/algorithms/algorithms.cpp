#include "orchard/voronoi/algorithms.h"

#include "orchard/voronoi/bowyer.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/inagaki.h"

namespace orchard {

std::string_view name(VoronoiAlgorithm algorithm) {
  switch (algorithm) {
    case VoronoiAlgorithm::bowyer:
      return "bowyer";
    case VoronoiAlgorithm::inagaki:
      return "inagaki";
    case VoronoiAlgorithm::highest_first:
      return "highest-first";
    case VoronoiAlgorithm::exact:
      break;
  }
  return "exact";
}

std::optional<VoronoiAlgorithm> voronoi_algorithm_named(std::string_view wanted) {
  for (const VoronoiAlgorithm algorithm : kVoronoiAlgorithms)
    if (name(algorithm) == wanted) return algorithm;
  return std::nullopt;
}

VoronoiBuild voronoi(std::span<const Point> points, VoronoiAlgorithm algorithm, const Progress& progress) {
  switch (algorithm) {
    case VoronoiAlgorithm::bowyer:
      return bowyer_voronoi(points, progress);
    case VoronoiAlgorithm::inagaki:
      return inagaki_voronoi(points, progress);
    case VoronoiAlgorithm::highest_first:
      return highest_first_voronoi(points, progress);
    case VoronoiAlgorithm::exact:
      break;
  }
  return exact_voronoi(points);
}

}  // namespace orchard
