#include "cell_neighbors.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace orchard::detail {

CellNeighbors::CellNeighbors(const VoronoiDiagram& diagram) : rows_(diagram.points.size()) {
  fill(diagram, std::vector<std::uint8_t>(rows_.size(), 1));
}

std::vector<std::uint8_t> CellNeighbors::update(const VoronoiDiagram& diagram, Index first_new) {
  rows_.resize(diagram.points.size());
  std::vector<std::uint8_t> changed(rows_.size(), 0);
  const auto is_new = [&](Index point) { return point != kInfinitePoint && point >= first_new; };
  for (const VoronoiVertex& vertex : diagram.vertices) {
    const auto& forming = vertex.forming_points;
    if (std::none_of(forming.begin(), forming.end(), is_new)) continue;
    for (const Index point : forming) {
      if (point != kInfinitePoint) changed[point] = 1;
    }
  }
  fill(diagram, changed);
  return changed;
}

void CellNeighbors::fill(const VoronoiDiagram& diagram, const std::vector<std::uint8_t>& wanted) {
  for (Index point = 0; point < rows_.size(); ++point) {
    if (wanted[point]) rows_[point].clear();
  }
  for (const VoronoiVertex& vertex : diagram.vertices) {
    for (const Index point : vertex.forming_points) {
      if (point == kInfinitePoint || !wanted[point]) continue;
      for (const Index other : vertex.forming_points) {
        if (other != point && other != kInfinitePoint) rows_[point].push_back(other);
      }
    }
  }
  tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t point) {
    if (!wanted[point]) return;
    std::vector<Index>& row = rows_[point];
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
  });
}

Index CellNeighbors::count_faces() const {
  std::size_t ends = 0;
  for (const auto& row : rows_) ends += row.size();
  return static_cast<Index>(ends / 2);
}

Index nearest_point(std::span<const Point> points, const CellNeighbors& neighbors, const Point& query, Index start) {
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
