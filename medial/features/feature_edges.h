#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Lengths in mesh units.
struct FeatureOptions {
  double min_loss = 0;    // what an edge loses, at least, if no sheet goes there; half of it where a chain goes on
  double min_length = 0;  // of a chain
};

// The convex edges of a mesh on which sheets of its medial axis end, with balls of radius 0: chains of edges that lose
// much of the surface if none does. What an edge loses is how far it lies outside the largest ball in its wedge, one
// that a third place of the surface stops. So a sharp edge of a coarse tube is none, and neither is a fold that is no
// deeper than what the axis leaves open anyway; an angle does not tell.
class FeatureEdges {
 public:
  // Those that lose much. O(n log n); parallel, deterministic.
  FeatureEdges(const Surface& surface, const FeatureOptions& options);
  // Those that are given, by the mesh's vertices. Throws InputError if one is no edge of the mesh.
  FeatureEdges(const Surface& surface, std::span<const std::array<Index, 2>> edges);

  // Of a triangle's side: see Feature.
  bool has(Index triangle, std::size_t side) const { return has_[triangle][side] != 0; }
  // By the mesh's vertices, ascending.
  const std::vector<std::array<Index, 2>>& edges() const { return edges_; }

 private:
  void add(const Surface& surface, Index triangle, std::size_t side);
  void sort_edges();

  std::vector<std::array<std::uint8_t, 3>> has_;
  std::vector<std::array<Index, 2>> edges_;
};

// How far a place of a convex edge lies outside the largest ball in the wedge of its two faces, mesh units. 0 for what
// is not convex.
double wedge_loss(const Surface& surface, Index triangle, std::size_t side, double part);

}  // namespace orchard::detail
