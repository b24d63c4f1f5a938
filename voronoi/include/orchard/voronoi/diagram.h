#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

namespace orchard {

// A forming point that stands for infinity: the vertex is the end of an unbounded Voronoi edge, dual to a facet of the
// convex hull. Keeping the outside symbolic keeps the hull cells right, which a large dummy tetrahedron does not.
inline constexpr Index kInfinitePoint = kNone;

// A Voronoi vertex, the dual of a Delaunay tetrahedron. Neighbour i shares all forming points but the i-th.
// One cache line.
struct alignas(64) VoronoiVertex {
  Point center;       // at infinity: the unit direction of the unbounded edge, pointing away from the hull
  double radius = 0;  // distance to the forming points; infinite at infinity
  std::array<Index, 4> forming_points{kNone, kNone, kNone, kNone};  // into points; positively oriented (see validate)
  std::array<Index, 4> neighbors{kNone, kNone, kNone, kNone};       // into vertices

  bool at_infinity() const {
    return forming_points[0] == kInfinitePoint || forming_points[1] == kInfinitePoint ||
           forming_points[2] == kInfinitePoint || forming_points[3] == kInfinitePoint;
  }
};

// A Voronoi diagram of points: the vertices of all cells, those at infinity included.
struct VoronoiDiagram {
  std::vector<Point> points;
  std::vector<VoronoiVertex> vertices;
};

// The faces of the diagram, one for each pair of points whose cells share one.
struct VoronoiFaces {
  std::vector<std::array<Index, 2>> points;  // the two cells, lower index first; rows ascending
  Rows vertices;  // of each face, in order around it, counter-clockwise seen from the second of its points; an
                  // unbounded face holds two neighbouring vertices at infinity
};

// O(n) over the vertices, up to the sort.
VoronoiFaces voronoi_faces(const VoronoiDiagram& diagram);

// For each point, the vertices that it forms, ascending. Points merged away have none.
Rows vertices_of_points(const VoronoiDiagram& diagram);

// Throws Error unless the structure is consistent: neighbours mutual and sharing three forming points, no vertex twice,
// Euler's formula for the triangulated 3-sphere, each cell's boundary a sphere, no two cells sharing two faces, and all
// vertices oriented alike. The orientation: forming points p0 p1 p2 p3 have (p1 - p0) x (p2 - p0) . (p3 - p0) > 0,
// where a point at infinity stands for any point beyond the hull's facet that the other three span. What is checked is
// that neighbours agree about it. Combinatorial, so it holds for every input however degenerate. Positions are not
// judged: that is what quality.h measures. A diagram without vertices passes. O(n log n).
void validate(const VoronoiDiagram& diagram);

}  // namespace orchard
