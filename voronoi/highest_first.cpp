#include "orchard/voronoi/highest_first.h"

#include "build.h"

namespace orchard {
namespace {

void copy_report(detail::BuildReport& from, HighestFirstReport* to) {
  if (to == nullptr) return;
  to->certified_insertions = from.counts.certified;
  to->settled_insertions = from.counts.settled;
  to->exact_insertions = from.counts.exact;
  to->constrained_insertions = from.counts.constrained;
  to->exact_signs = from.exact;
  to->coplanar_centers = from.counts.coplanar;
  to->duplicates = std::move(from.duplicates);
}

}  // namespace

VoronoiDiagram highest_first_voronoi(std::span<const Point> points, const Progress& progress,
                                     HighestFirstReport* report) {
  detail::BuildReport own;
  VoronoiDiagram diagram =
      detail::build_voronoi(points, detail::Search::highest_first, "Voronoi diagram", progress, own);
  copy_report(own, report);
  return diagram;
}

}  // namespace orchard
