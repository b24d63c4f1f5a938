#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Lengths in mesh units.
struct FeatureOptions {
  double min_loss = 0;    // least loss of a feature edge; half of it is enough where a chain continues
  double min_length = 0;  // least length of a chain
};

// The convex edges of a mesh at which sheets of its medial axis have to end, with balls of radius 0: chains of edges
// that would be left open by much if no sheet ended there. An edge's loss measures that: it is the edge's distance from
// the largest ball in its wedge, which a third place of the surface stops. By this measure a sharp edge of a coarse
// tube is no feature edge, nor is a ridge that is no higher than what the axis leaves open anyway; the angle at the
// edge could not tell these apart.
class FeatureEdges {
 public:
  // Finds the edges with a large loss. O(n log n); parallel, deterministic.
  FeatureEdges(const Surface& surface, const FeatureOptions& options);
  // Takes the given edges, as pairs of the mesh's vertices. Throws InputError if one is no edge of the mesh.
  FeatureEdges(const Surface& surface, std::span<const std::array<Index, 2>> edges);

  // Whether a side of a triangle is a feature edge. Sides are numbered as in Feature.
  bool has(Index triangle, std::size_t side) const { return has_[triangle][side] != 0; }
  // The feature edges as pairs of the mesh's vertices, ascending.
  const std::vector<std::array<Index, 2>>& edges() const { return edges_; }

 private:
  void add(const Surface& surface, Index triangle, std::size_t side);
  void sort_edges();

  std::vector<std::array<std::uint8_t, 3>> has_;
  std::vector<std::array<Index, 2>> edges_;
};

// The loss at a place of a convex edge, in mesh units: the distance of the place from the largest ball in the wedge of
// the edge's two faces. 0 if the edge is not convex.
double wedge_loss(const Surface& surface, Index triangle, std::size_t side, double part);

}  // namespace orchard::detail
