#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// Half-edge 3 * t + i runs from corner i to corner (i + 1) % 3 of triangle t.
struct EdgeUse {
  Index low = 0, high = 0;  // the edge's vertices
  Index half_edge = 0;
};

// Returns all half-edges, with those of an edge next to each other in ascending order, and the edges in lexicographic
// order. Triangles with a repeated corner are left out. The triangles may be any with valid indices. O(n) except for
// vertices of high degree.
std::vector<EdgeUse> sorted_edge_uses(const TriangleMesh& mesh);

// Calls visit(std::span<const EdgeUse>) for each edge, in order.
template <typename Visit>
void for_each_edge(std::span<const EdgeUse> uses, const Visit& visit) {
  for (std::size_t first = 0, last = 0; first < uses.size(); first = last) {
    while (last < uses.size() && uses[last].low == uses[first].low && uses[last].high == uses[first].high) ++last;
    visit(uses.subspan(first, last - first));
  }
}

// Returns the triangle across edge i of each triangle; kNone at a boundary and where more than two triangles meet.
std::vector<std::array<Index, 3>> triangle_neighbors(const TriangleMesh& mesh);

// Returns the triangles at each vertex, ascending. A triangle with a repeated corner is listed once.
Rows triangles_around_vertices(const TriangleMesh& mesh);

}  // namespace orchard
