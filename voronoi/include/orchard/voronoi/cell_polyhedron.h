#pragma once
#include "orchard/voronoi/views.h"

// Voronoi cells as convex polyhedra, clipped by a box.
namespace orchard {

// A convex polyhedron. If it is empty, it has no corners.
struct CellPolyhedron {
  std::vector<Point> corners;
  Rows faces;                    // The corners of each face, counter-clockwise seen from outside.
  std::vector<Index> neighbors;  // For each face, the point whose cell lies beyond it; kNone on the box.
};

// Returns the part of a point's cell that lies in a box: the box, cut by the bisector planes between the point and the
// points whose cells share a face with its cell. The result is empty for a point that forms no vertex.
// The positions of the vertices are not used. The result is the true cell if the neighbours are right, whether the cell
// is bounded or not; if they are wrong, cells overlap. O(k^2) for k faces.
CellPolyhedron clipped_cell(const VoronoiDiagram& diagram, const VoronoiCells& cells, Index point, const Box& box);

// Returns the volume of a polyhedron in cubic mesh units.
double volume(const CellPolyhedron& polyhedron);

}  // namespace orchard
