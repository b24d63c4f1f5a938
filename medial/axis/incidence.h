#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// Which cells of a complex meet which.
namespace orchard::detail {

// For each of `count` first items, the second ones of its pairs, ascending, each once. O(n) for short rows.
Rows rows_of(const std::vector<std::array<Index, 2>>& pairs, Index count);

// The only living cell of a row; kNone if there is none, or more than one.
Index only(std::span<const Index> row, const std::vector<std::uint8_t>& alive);

// Sorts the corners of edges and triangles, then these; drops repeated ones and adds the edges of triangles. O(n) where
// vertices have few cells.
void complete_cells(std::vector<std::array<Index, 2>>& edges, std::vector<std::array<Index, 3>>& triangles);

// Adds triangles and their edges, and edges, to complete cells, which stay so. Sorts only what is added.
void insert_cells(std::vector<std::array<Index, 2>>& edges, std::vector<std::array<Index, 3>>& triangles,
                  std::vector<std::array<Index, 2>> more_edges, std::vector<std::array<Index, 3>> more_triangles);

// The numbers of sorted edges, by their corners, which are below `vertices`. `edges` must outlive it, unchanged. O(n).
class EdgeNumbers {
 public:
  EdgeNumbers(const std::vector<std::array<Index, 2>>& edges, Index vertices);

  // Of an edge that there is. O(log d) for d edges at its lower corner.
  Index operator()(Index a, Index b) const;

 private:
  const std::vector<std::array<Index, 2>>& edges_;
  std::vector<Index> begin_;  // for each lower corner, and the end
};

// Of complete cells with corners below `vertices`; lists of cells are ascending. O(n) where vertices have few cells.
struct CellIncidence {
  CellIncidence(const std::vector<std::array<Index, 2>>& edges, const std::vector<std::array<Index, 3>>& triangles,
                Index vertices);

  std::vector<Index> border_edges() const;   // with just one triangle
  std::vector<Index> bare_edges() const;     // without a triangle
  std::vector<Index> lone_vertices() const;  // without an edge

  std::vector<std::array<Index, 3>> sides;  // of each triangle: the edges ab, ac and bc
  Rows triangles_at, edges_at;              // of each edge; of each vertex
};

}  // namespace orchard::detail
