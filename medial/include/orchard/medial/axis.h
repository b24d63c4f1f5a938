#pragma once
#include <vector>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/diagram.h"

// The medial axis of a solid as a subset of a Voronoi diagram.
namespace orchard {

// The approximate medial-axis surface of a solid: the Voronoi vertices inside it, with coincident ones merged into one,
// and their edges and faces. Source: dissertation 6.2.1.
struct MedialAxis {
  std::vector<Point> points;    // The surface points, which forming_points refers to.
  std::vector<Vector> normals;  // The outward unit pseudonormal of the surface at each point.
  // For each point, the angle in radians between `normals[i]` and the normals of the adjacent faces; it is 0 except at
  // edges and vertices.
  std::vector<double> turns;
  std::vector<PointOrigin> origins;  // The stage that added each point.

  std::vector<Point> centers;  // The positions of the medial vertices.
  std::vector<double> radii;   // The distance of each vertex to its forming points, in mesh units.
  // For each vertex, the angle in radians between the two contacts that are seen farthest apart from it. It is twice
  // the object angle.
  std::vector<double> angles;
  // The forming points of each vertex, ascending: four, or more if vertices were merged.
  Rows forming_points;
  Rows neighbors;  // The vertices joined to each vertex by a Voronoi edge, ascending; symmetric.

  // The two points that each face separates. A face is a Voronoi polygon between two points that do not share a
  // triangle or an edge of the surface; all corners of the polygon are vertices of the axis. Faces are the sheets to
  // draw.
  std::vector<std::array<Index, 2>> face_points;
  Rows faces;  // The vertices of each face in order around it.

  // The two points that each topology face separates. Topology faces are the other Voronoi polygons all of whose
  // corners are vertices of the axis: those between two points that share a triangle or an edge of the surface. Such a
  // face points at the surface but does not reach it, and is not drawn. The sheets alone have holes where these faces
  // are; with them, the axis has the topology of the solid (gap_crossing.h).
  std::vector<std::array<Index, 2>> topology_face_points;
  Rows topology_faces;  // The vertices of each of them in order around it.

  // Three counts of AxisOptions::keep_topology: vertices that are joined by one edge alone and have no faces, edges
  // that do not exist in the diagram, and interior vertices that were dropped.
  Index stems = 0, bridges = 0, left_out = 0;

  Index size() const { return static_cast<Index>(centers.size()); }
};

// The options of medial_axis().
struct AxisOptions {
  // Adjacent Voronoi vertices that are nearer than this, as a fraction of the bounding radius, become one vertex.
  double coalesce = tolerance::kCoalesce;
  // Whether the axis is forced to the topology of the solid. Gap crossings that could not be repaired, for example
  // those of a surface that cuts itself, may give the axis another number of components or another Euler characteristic
  // than the solid. If so, and if the components of the solid are balls, the axis keeps only those vertices that can be
  // added one after the other, the largest balls first, without a change of topology. Each of the other vertices is
  // then added by one edge.
  bool keep_topology = false;
};

// Extracts the medial axis from a Voronoi diagram of surface points. Precondition: diagram.points equals
// sampling.points. Throws InputError unless surface.solid().
MedialAxis medial_axis(const Surface& surface, const SurfaceSampling& sampling, const VoronoiDiagram& diagram,
                       const AxisOptions& options = {}, const Progress& progress = {});

// Returns the connected component of each vertex, numbered from 0, and stores the number of components in `count`.
std::vector<Index> connected_components(const MedialAxis& axis, Index& count);

// Throws Error unless the adjacency is symmetric, all indices are in range and every centre lies inside the surface.
void validate(const MedialAxis& axis, const Surface& surface);

}  // namespace orchard
