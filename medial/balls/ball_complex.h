#pragma once
#include <array>
#include <vector>

#include "../axis/incidence.h"
#include "exact_ball.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// A medial mesh with the contacts of its vertices. Edges are sorted and occur once, including those of triangles. In a
// complete complex, the same holds for triangles.
struct BallComplex {
  std::vector<ExactBall> balls;
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::array<Index, 3>> triangles;

  Index size() const { return static_cast<Index>(balls.size()); }
  MedialMesh mesh() const;
  // Sorts edges and triangles, drops repeated ones and adds the edges of triangles.
  void complete();
  EdgeNumbers edge_numbers() const { return {edges, size()}; }
};

// Divides edges of a complete complex, and the triangles at these edges, which does not change the topology. cut[e] is
// the vertex that divides edge e, which must be in `complex.balls`; kNone if the edge is not divided. Takes O(n), and
// O(log n) for each cut.
void subdivide(BallComplex& complex, const std::vector<Index>& cut);

// The cells of a complex that are kept, by their numbers.
struct Alive {
  std::vector<std::uint8_t> vertices, edges, triangles;
};

// Removes all other cells, and keeps the order. Precondition: the corners and sides of kept cells are kept. O(n).
void keep_alive(BallComplex& complex, const Alive& alive);

// The edges and vertices that may be removed. A triangle may be removed if one of its edges may.
struct Doomed {
  // At first, nothing may be removed.
  explicit Doomed(const BallComplex& complex) : edges(complex.edges.size(), 0), vertices(complex.balls.size(), 0) {}

  std::vector<std::uint8_t> edges, vertices;
};

// Collapses cells from their free ends on: triangles at free edges, and edges at free vertices, if these may be
// removed. This does not change the topology. Edges whose ends have the smallest value come first. Cells without a free
// side remain. O(n log n).
void collapse(BallComplex& complex, const Doomed& doomed, const std::vector<double>& value_of_vertex);

}  // namespace orchard::detail
