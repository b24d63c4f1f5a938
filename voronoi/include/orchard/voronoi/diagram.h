#pragma once
#include <array>
#include <span>
#include <vector>

#include "orchard/geometry/mesh.h"

// The data structure of a three-dimensional Voronoi diagram.
namespace orchard {

// A forming point that stands for infinity. A vertex with this point is the end of an unbounded Voronoi edge, which is
// dual to a facet of the convex hull. The cells of hull points are right because the outside is symbolic; with a large
// dummy tetrahedron they would not be.
inline constexpr Index kInfinitePoint = kNone;

// A Voronoi vertex, the dual of a Delaunay tetrahedron. Neighbour i shares all forming points but the i-th. A vertex
// fills one cache line.
struct alignas(64) VoronoiVertex {
  // The position. Of a vertex at infinity, it is the unit direction of the unbounded edge, which points away from the
  // hull.
  Point center;
  double radius = 0;  // The distance to the forming points; infinite at infinity.
  std::array<Index, 4> forming_points{kNone, kNone, kNone, kNone};  // Into points; positively oriented (see validate).
  std::array<Index, 4> neighbors{kNone, kNone, kNone, kNone};       // Into vertices.

  // Returns whether one of the forming points is kInfinitePoint.
  bool at_infinity() const {
    return forming_points[0] == kInfinitePoint || forming_points[1] == kInfinitePoint ||
           forming_points[2] == kInfinitePoint || forming_points[3] == kInfinitePoint;
  }
};

// A Voronoi diagram of points. Its vertices include those at infinity.
struct VoronoiDiagram {
  std::vector<Point> points;
  std::vector<VoronoiVertex> vertices;
};

// The faces of a diagram as arrays, one face for each pair of points whose cells share one.
struct VoronoiFaces {
  std::vector<std::array<Index, 2>> points;  // The points of the two cells, lower index first; rows ascending.
  // The vertices of each face in order around it, counter-clockwise seen from the second of its points. An unbounded
  // face contains two neighbouring vertices at infinity.
  Rows vertices;
};

// Returns all faces of a diagram. Takes O(n) for n vertices, apart from the sort.
VoronoiFaces voronoi_faces(const VoronoiDiagram& diagram);

// Returns, for each point, the vertices that it forms, ascending. Points that were merged with another have none.
Rows vertices_of_points(const VoronoiDiagram& diagram);

// Checks that the structure of a diagram is consistent. Throws Error unless
// - neighbours are mutual and share three forming points, and no vertex occurs twice;
// - Euler's formula for the triangulated 3-sphere holds;
// - the boundary of each cell is a sphere, and no two cells share two faces;
// - all vertices are oriented alike: forming points p0 p1 p2 p3 have (p1 - p0) x (p2 - p0) . (p3 - p0) > 0, where a
//   point at infinity stands for any point beyond the hull's facet that the other three span. The check is that
//   neighbours agree about the orientation.
// The check is combinatorial, so it applies to all inputs, however degenerate; quality.h measures positions. A diagram
// without vertices passes. O(n log n).
void validate(const VoronoiDiagram& diagram);

}  // namespace orchard
