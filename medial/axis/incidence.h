#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// The incidence of the cells of a complex.
namespace orchard::detail {

// Returns a row for each number below `count`: the second items of the pairs that have this number first, ascending,
// each once. O(n) for short rows.
Rows rows_of(const std::vector<std::array<Index, 2>>& pairs, Index count);

// The living cell of a row if there is exactly one, else kNone.
Index only(std::span<const Index> row, const std::vector<std::uint8_t>& alive);

// Makes cells complete: sorts the corners of each edge and triangle, sorts the cells, drops repeated ones, and adds the
// edges of triangles. O(n) if vertices have few cells.
void complete_cells(std::vector<std::array<Index, 2>>& edges, std::vector<std::array<Index, 3>>& triangles);

// Adds edges, triangles and the edges of these triangles to complete cells, which stay complete. Sorts only what is
// added.
void insert_cells(std::vector<std::array<Index, 2>>& edges, std::vector<std::array<Index, 3>>& triangles,
                  std::vector<std::array<Index, 2>> more_edges, std::vector<std::array<Index, 3>> more_triangles);

// Finds the number of an edge by its corners, in a sorted list of edges whose corners are below `vertices`. `edges`
// must outlive it and not change. O(n).
class EdgeNumbers {
 public:
  EdgeNumbers(const std::vector<std::array<Index, 2>>& edges, Index vertices);

  // Precondition: the edge exists. O(log d) for d edges at its lower corner.
  Index operator()(Index a, Index b) const;

 private:
  const std::vector<std::array<Index, 2>>& edges_;
  std::vector<Index> begin_;  // where the edges of each lower corner begin, and the end
};

// The incidence of complete cells whose corners are below `vertices`. Lists of cells are ascending. O(n) if vertices
// have few cells.
struct CellIncidence {
  CellIncidence(const std::vector<std::array<Index, 2>>& edges, const std::vector<std::array<Index, 3>>& triangles,
                Index vertices);

  std::vector<Index> border_edges() const;   // with just one triangle
  std::vector<Index> bare_edges() const;     // without a triangle
  std::vector<Index> lone_vertices() const;  // without an edge

  std::vector<std::array<Index, 3>> sides;  // of each triangle: the edges ab, ac and bc
  Rows triangles_at, edges_at;              // triangles at each edge; edges at each vertex
};

}  // namespace orchard::detail
