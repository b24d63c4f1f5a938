#pragma once
#include <unordered_set>
#include <vector>

#include "../balls/ball_complex.h"

namespace orchard::detail {

// Adds cells to a complete complex that change no topology: triangles that meet it in one edge, their third vertex
// being new, or in two edges; and edges to new vertices. What is added could be collapsed again from its free ends on.
class FreeExtension {
 public:
  explicit FreeExtension(BallComplex& complex) : complex_(complex), first_new_(complex.size()) {}

  bool joined(Index a, Index b) const;
  // A vertex for triangles to come. It is dropped if none comes.
  Index add_vertex(const ExactBall& ball);
  // False, and nothing is added, if that would change the topology.
  bool add(Index a, Index b, Index c);
  // The edge from a vertex to a new one that nothing has yet: a curve goes on. False if there is such.
  bool add_edge(Index from, Index to);
  // The strip between the edge ab and the edge xy: two triangles along the shorter diagonal, or what of them is free;
  // one triangle if x is y.
  void add_strip(Index a, Index b, Index x, Index y);
  // Completes the complex. Returns how many triangles and edges without triangles were added.
  Index finish();

 private:
  static std::uint64_t key(Index a, Index b) { return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b); }
  bool is_unused(Index v) const { return v >= first_new_ && !used_[v - first_new_]; }
  double apart(Index a, Index b) const { return (complex_.balls[a].center - complex_.balls[b].center).squaredNorm(); }

  BallComplex& complex_;
  const Index first_new_;
  std::vector<std::uint8_t> used_;  // of the new vertices
  std::vector<std::array<Index, 3>> added_;
  std::vector<std::array<Index, 2>> added_edges_;  // of curves
  std::unordered_set<std::uint64_t> new_edges_;    // asked only whether it holds a pair
};

}  // namespace orchard::detail
