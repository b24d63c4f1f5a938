#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "orchard/medial/axis.h"

// Divides a medial axis into sheets and curves, and extracts its graph of lines.
namespace orchard {

// The options of medial_segments().
struct SegmentOptions {
  // A length in mesh units, at least 0. A vertex with a radius up to this counts as touching the surface. A good value
  // is twice the spacing of the surface points, which do not resolve smaller parts.
  double touching = 0;
  // An angle in radians. A face is a spur if its separation_angle() (prune.h) is smaller; it neither starts a sheet nor
  // separates two sheets. The default is 60 degrees.
  double angle = 1.0472;
};

// The parts of an axis between the places where it branches: sheets of faces that are joined across edges with exactly
// two faces, and curves of edges without faces. A branch is a segment with a vertex that touches the surface (see
// SegmentOptions::touching); a trunk is a segment without such a vertex. Spurs and topology faces do not count as faces
// of an edge, and faces are not joined across an edge with an end that touches the surface. A sheet has at least one
// face without a vertex that touches the surface. The remaining faces are added to the sheet that is the fewest faces
// away. Source: Goldak, Yu, Knight, Dong 1991, as summarised in dissertation 6.2.1.
struct MedialSegments {
  struct Segment {
    bool has_faces = false;  // Whether the segment is a sheet; otherwise it is a curve.
    bool trunk = false;      // Whether the segment is a trunk; otherwise it is a branch.
    Index cells = 0;         // The number of faces and topology faces of a sheet, or of edges of a curve.
    double min_radius = 0, max_radius = 0;  // Of its vertices, in mesh units.
  };
  std::vector<Segment> segments;
  std::vector<Index> of_face, of_topology_face;  // The segment of each face and topology face.
  // The segment of each edge, in the order of (vertex, larger neighbour); kNone for edges of faces.
  std::vector<Index> of_edge;
  // The segment of each vertex: the one that has the most cells there, or the first of several such segments. kNone for
  // a vertex without neighbours.
  std::vector<Index> of_vertex;
};

// Divides an axis into segments. Sheets come first, in the order of their first face. O(n log n).
MedialSegments medial_segments(const MedialAxis& axis, const SegmentOptions& options);

// The lines of an axis as a graph. A line is a border of a sheet, a seam where three or more sheets meet, or a curve.
// The nodes are the ends of lines and the places where lines meet or change their kind. A closed line has one node.
struct StructureGraph {
  enum class Kind : std::uint8_t { curve, border, seam };
  struct Arc {
    Index from = 0, to = 0;  // The nodes at the ends, as indices into `nodes`.
    Kind kind = Kind::curve;
    std::vector<Index> vertices;  // Vertices of the axis along the line, ends included.
    double length = 0;            // In mesh units.
    double mean_radius = 0;       // The mean over the vertices, in mesh units.
  };
  std::vector<Index> nodes;  // Vertices of the axis, ascending.
  std::vector<Arc> arcs;
};
// Returns the lines of an axis as a graph.
StructureGraph structure_graph(const MedialAxis& axis);

// Returns the text of a GraphML file. Nodes have x, y, z and radius; edges have kind, length and mean_radius.
std::string to_graphml(const StructureGraph& graph, const MedialAxis& axis);

}  // namespace orchard
