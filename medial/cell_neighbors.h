#pragma once
#include <span>
#include <vector>

#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// For each point the points whose Voronoi cells adjoin its own, ascending; none for a point without a cell. Parallel.
Rows cell_neighbors(const VoronoiDiagram& diagram);

// The point nearest to `query` among those joined to `start` by cells: steps to any nearer neighbour until none
// is left, which is exact on a Voronoi diagram. Precondition: `start` has a cell.
Index nearest_point(std::span<const Point> points, const Rows& neighbors, const Point& query, Index start);

}  // namespace orchard::detail
