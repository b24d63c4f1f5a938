#pragma once
#include <span>
#include <string_view>

#include "insertion.h"
#include "orchard/geometry/progress.h"
#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

struct BuildReport {
  InsertionCounts counts;
  bool exact = false;                            // all signs had to be
  std::vector<std::array<Index, 2>> duplicates;  // (point left out, point it coincides with)
};

// What the incremental methods share: leaving out coincident points, ordering, the first four points, insertion, and
// turning the workspace into a diagram.
VoronoiDiagram build_voronoi(std::span<const Point> points, Search search, std::string_view stage,
                             const Progress& progress, BuildReport& report);

void insert_into(VoronoiDiagram& diagram, std::span<const Point> points, BuildReport& report);

}  // namespace orchard::detail
