#pragma once
#include <array>
#include <vector>

#include "../axis/incidence.h"
#include "exact_ball.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// A medial mesh whose vertices know their contacts. Edges are sorted and each there once, those of triangles included.
// Complete: triangles as well.
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

// Cuts edges of a complete complex in two, and with them the triangles at them: the same topology. cut[e] is the vertex
// that divides edge e, which is in `complex.balls` already, or kNone. O(n) and O(log n) for each cut.
void subdivide(BallComplex& complex, const std::vector<Index>& cut);

// Which cells of a complex stay, by their numbers.
struct Alive {
  std::vector<std::uint8_t> vertices, edges, triangles;
};

// Takes all other cells away; what stays must have its corners and sides. The order stays. O(n).
void keep_alive(BallComplex& complex, const Alive& alive);

// What may be taken away, by edges and vertices; a triangle may go if one of its edges may. Nothing else does.
struct Doomed {
  // Nothing yet.
  explicit Doomed(const BallComplex& complex) : edges(complex.edges.size(), 0), vertices(complex.balls.size(), 0) {}

  std::vector<std::uint8_t> edges, vertices;
};

// Takes away cells from the free ends on, triangles at free doomed edges and doomed edges at free doomed vertices,
// which changes no topology; edges with the least value of an end first. What has nothing free stays. O(n log n).
void collapse(BallComplex& complex, const Doomed& doomed, const std::vector<double>& value_of_vertex);

}  // namespace orchard::detail
