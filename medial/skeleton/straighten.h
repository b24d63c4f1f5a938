#pragma once
#include <cstdint>
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/medial/medial_mesh.h"

namespace orchard::detail {

// A graph in space whose edges lie on an axis.
struct CurveGraph {
  std::vector<Point> vertices;
  std::vector<std::array<Index, 2>> edges;
  std::vector<std::uint8_t> fixed;  // of each vertex: 1 if it must not move
};

// What straightening did, in mesh units.
struct Straightened {
  double max_moved = 0;      // the largest distance of a vertex from where it started
  double axis_distance = 0;  // an upper bound on the distance of places on moved edges from the axis
};

// Straightens the curves of a graph. Vertices move towards the middle of their neighbours, then back by as much on a
// larger scale so that curves do not shrink (Taubin 1995), and then onto the nearest place of `sheets`, a surface of
// the axis' triangles. No vertex ends farther than `limit` (mesh units) from where it started.
//
// This is a homotopy in the solid: let p and q be the ends of an edge of length l, with distances r and s to the
// surface. The ball around the place (1 - u) p + u q in the solid has a radius of at least max(r - u l, s - (1 - u) l),
// which is at least (r + s - l) / 2. No vertex moves by more than that bound of any of its edges. The place moves
// straight, by at most the larger of the moves of p and q, so it stays in its ball. O(k log n) for k vertices and n
// triangles.
Straightened straighten(CurveGraph& graph, const Surface& surface, const Surface& sheets, double limit, int rounds);

}  // namespace orchard::detail
