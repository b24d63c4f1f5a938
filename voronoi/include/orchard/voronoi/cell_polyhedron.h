#pragma once
#include "orchard/voronoi/views.h"

namespace orchard {

// A convex polyhedron; no corners if it is empty.
struct CellPolyhedron {
  std::vector<Point> corners;
  Rows faces;                    // into corners, counter-clockwise seen from outside
  std::vector<Index> neighbors;  // of each face: the point whose cell is beyond it, kNone on the box
};

// The part of a point's cell that is in the box: the box, cut by the planes half-way to the points whose cells share a
// face with it. The positions of the vertices do not matter, so this is the true cell where the neighbours are right,
// unbounded or not; where they are wrong, cells overlap. Empty for a point that forms no vertex. O(k^2) for k faces.
CellPolyhedron clipped_cell(const VoronoiDiagram& diagram, const VoronoiCells& cells, Index point, const Box& box);

double volume(const CellPolyhedron& polyhedron);

}  // namespace orchard
