#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// For each point the points whose Voronoi cells adjoin its own, ascending; none for a point without a cell.
class CellNeighbors {
 public:
  // O(vertices), parallel.
  explicit CellNeighbors(const VoronoiDiagram& diagram);

  // Brings the rows up to date after points from index `first_new` on were inserted. Returns for each point whether its
  // cell changed: the new points and their neighbours.
  std::vector<std::uint8_t> update(const VoronoiDiagram& diagram, Index first_new);

  Index size() const { return static_cast<Index>(rows_.size()); }
  std::span<const Index> operator[](Index point) const { return rows_[point]; }
  Index count_faces() const;

 private:
  void fill(const VoronoiDiagram& diagram, const std::vector<std::uint8_t>& wanted);

  std::vector<std::vector<Index>> rows_;
};

// The point nearest to `query` among those joined to `start` by cells: steps to any nearer neighbour until none is
// left, which is exact on a Voronoi diagram. Precondition: `start` has a cell.
Index nearest_point(std::span<const Point> points, const CellNeighbors& neighbors, const Point& query, Index start);

}  // namespace orchard::detail
