#pragma once
#include <unordered_set>
#include <vector>

#include "../balls/ball_complex.h"

namespace orchard::detail {

// Adds cells to a complete complex without a change of topology: triangles that share one edge with it and have a new
// third vertex, triangles that share two edges with it, and edges to new vertices. The added cells could be collapsed
// again from their free ends on.
class FreeExtension {
 public:
  explicit FreeExtension(BallComplex& complex) : complex_(complex), first_new_(complex.size()) {}

  bool joined(Index a, Index b) const;
  // Adds a vertex for later triangles. It is dropped if no cell uses it.
  Index add_vertex(const ExactBall& ball);
  // Adds a triangle. Returns false and adds nothing if that would change the topology.
  bool add(Index a, Index b, Index c);
  // Continues a curve by an edge from a vertex to a new vertex. Returns false if a cell already uses the new vertex.
  bool add_edge(Index from, Index to);
  // Adds the strip between the edges ab and xy: two triangles along the shorter diagonal, or only those that do not
  // change the topology. If x is y, it is one triangle.
  void add_strip(Index a, Index b, Index x, Index y);
  // Completes the complex. Returns the number of triangles and of edges without triangles that were added.
  Index finish();

 private:
  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
  bool is_unused(Index v) const { return v >= first_new_ && !used_[v - first_new_]; }
  double apart(Index a, Index b) const { return (complex_.balls[a].center - complex_.balls[b].center).squaredNorm(); }

  BallComplex& complex_;
  const Index first_new_;
  std::vector<std::uint8_t> used_;  // for each new vertex
  std::vector<std::array<Index, 3>> added_;
  std::vector<std::array<Index, 2>> added_edges_;  // of curves
  std::unordered_set<std::uint64_t> new_edges_;    // used only to test whether it contains a pair
};

}  // namespace orchard::detail
