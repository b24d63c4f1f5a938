#include "cell_neighbors.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace orchard::detail {

Rows cell_neighbors(const VoronoiDiagram& diagram) {
  const Rows formed = vertices_of_points(diagram);
  const Index size = static_cast<Index>(diagram.points.size());
  std::vector<std::vector<Index>> rows(size);
  tbb::parallel_for(Index{0}, size, [&](Index point) {
    std::vector<Index>& row = rows[point];
    row.reserve(3 * formed[point].size());
    for (const Index vertex : formed[point]) {
      for (const Index other : diagram.vertices[vertex].forming_points) {
        if (other != point && other != kInfinitePoint) row.push_back(other);
      }
    }
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  });
  Rows result;
  for (const std::vector<Index>& row : rows) {
    result.items.insert(result.items.end(), row.begin(), row.end());
    result.close_row();
  }
  return result;
}

Index nearest_point(std::span<const Point> points, const Rows& neighbors, const Point& query, Index start) {
  Index nearest = start;
  double squared = (points[start] - query).squaredNorm();
  for (bool moved = true; moved;) {
    moved = false;
    for (const Index next : neighbors[nearest]) {
      const double candidate = (points[next] - query).squaredNorm();
      if (candidate < squared) {
        squared = candidate;
        nearest = next;
        moved = true;
        break;
      }
    }
  }
  return nearest;
}

}  // namespace orchard::detail
