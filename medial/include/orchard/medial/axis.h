#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/diagram.h"

namespace orchard {

// The approximate medial-axis surface of a solid (dissertation 6.2.1): the Voronoi vertices inside it, coincident ones
// coalesced, and how they hang together.
struct MedialAxis {
  std::vector<Point> points;    // surface points: what forming points index
  std::vector<Vector> normals;  // outward unit pseudonormal of the surface at each point
  std::vector<double> turns;    // radians from that to the surface's own normals there: 0 but at edges and vertices
  std::vector<PointOrigin> origins;  // of each point: which of them gap repair added

  std::vector<Point> centers;  // medial vertices
  std::vector<double> radii;   // distance to the forming points
  std::vector<double> angles;  // radians between the contacts that are seen farthest apart: twice the object angle
  Rows forming_points;         // of each vertex, ascending; four, or more where vertices were coalesced
  Rows neighbors;              // vertices joined by a Voronoi edge, ascending; symmetric

  // Faces to draw: polygons of the dual of two points, all of whose corners are vertices of the axis, and whose points
  // do not share a triangle or an edge of the surface.
  std::vector<std::array<Index, 2>> face_points;
  Rows faces;  // vertices in order around each face

  // The other faces all of whose corners are vertices of the axis: they stand on the surface without reaching it. The
  // sheets alone have holes where these are; with them, the axis hangs together as the solid does (gap_crossing.h).
  std::vector<std::array<Index, 2>> wall_points;
  Rows walls;

  // By AxisOptions::keep_topology: vertices that are joined by one edge alone, without faces; edges that are none of
  // the diagram's; and interior vertices dropped.
  Index stems = 0, bridges = 0, left_out = 0;

  Index size() const { return static_cast<Index>(centers.size()); }
};

struct AxisOptions {
  double coalesce = tolerance::kCoalesce;  // Voronoi vertices nearer than this, in bounding radii, become one
  // Where crossings that could not be mended (of a surface that cuts itself, say) leave an axis with other components
  // or another Euler characteristic than the solid, and the solid's components are balls: keep only as many vertices as
  // can be taken in one after the other, largest balls first, without a change of topology; then the others, by one
  // edge each.
  bool keep_topology = false;
};

// Precondition: diagram.points equals sampling.points. Throws InputError unless surface.solid().
MedialAxis medial_axis(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                       const AxisOptions& options = {}, const Progress& progress = {});

// Numbers the connected components of the vertices' adjacency; returns the component of each vertex.
std::vector<Index> connected_components(const MedialAxis& axis, Index& count);

// Throws Error unless adjacency is symmetric, indices are in range and every centre lies inside the surface.
void validate(const MedialAxis& axis, const Surface& surface);

}  // namespace orchard
