#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/voronoi/diagram.h"

namespace orchard::detail {

// Lists for each point the points whose Voronoi cells are adjacent to its own, ascending; the list is empty for a point
// without a cell.
class CellNeighbors {
 public:
  // O(vertices), parallel.
  explicit CellNeighbors(const VoronoiDiagram& diagram);

  // Updates the lists after the points from index `first_new` on have been inserted. Returns for each point whether its
  // cell has changed, which is so for the new points and their neighbours.
  std::vector<std::uint8_t> update(const VoronoiDiagram& diagram, Index first_new);

  Index size() const { return static_cast<Index>(rows_.size()); }
  std::span<const Index> operator[](Index point) const { return rows_[point]; }
  Index count_faces() const;

 private:
  void fill(const VoronoiDiagram& diagram, const std::vector<std::uint8_t>& wanted);

  std::vector<std::vector<Index>> rows_;
};

// Returns the point nearest to `query` in the connected part of the cells that contains `start`. It moves to a nearer
// neighbour as long as there is one, which is exact in a Voronoi diagram. Precondition: `start` has a cell.
Index nearest_point(std::span<const Point> points, const CellNeighbors& neighbors, const Point& query, Index start);

}  // namespace orchard::detail
