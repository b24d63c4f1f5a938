#pragma once
#include <array>
#include <vector>

#include "../balls/ball_complex.h"
#include "../features/feature_edges.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Returns pairs of vertices of radius 0 that are next to each other on a feature edge of the mesh, or around a corner
// where two such edges meet, without an edge of the complex between them along the feature edge. They are in the order
// of the vertices of the mesh. O(n log n).
std::vector<std::array<Index, 2>> gaps_on_edges(const Surface& surface, const BallComplex& complex,
                                                const FeatureEdges& features);

// An edge of the complex that passes a corner of the mesh, between places on two feature edges that meet there.
struct EdgeAroundCorner {
  Index corner;  // a vertex of the mesh
  Index edge;    // an edge of the complex
};

// Returns the edges of the complex that pass corners in which three or more feature edges meet, if there is no vertex
// at the corner; at each corner, the shortest. They are in the order of the vertices of the mesh. O(n log n).
std::vector<EdgeAroundCorner> edges_around_corners(const Surface& surface, const BallComplex& complex,
                                                   const FeatureEdges& features);

}  // namespace orchard::detail
