#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "orchard/medial/axis.h"

namespace orchard {

struct SegmentOptions {
  // Mesh units: a vertex with a radius up to this nearly touches the surface. Twice the spacing of the surface points
  // is about where what they resolve ends.
  double touching = 0;
  // Radians: faces whose points are seen at less than this are spurs; no sheet starts or ends at them.
  double angle = 1.0472;
};

// The parts of an axis between the places where it branches (Goldak, Yu, Knight, Dong 1991, as dissertation 6.2.1 sums
// them up): sheets of faces joined across edges that only two faces share, and curves of edges without faces. A branch
// touches the surface, or nearly: it holds a vertex that does. A trunk does not. Spurs, walls and what nearly touches
// do not count as faces at an edge; they go to the sheet that is fewest faces away.
struct MedialSegments {
  struct Segment {
    bool sheet = false;  // else a curve
    bool trunk = false;  // else a branch
    Index cells = 0;     // faces and walls of a sheet, edges of a curve
    double min_radius = 0, max_radius = 0;
  };
  std::vector<Segment> segments;
  std::vector<Index> of_face, of_wall;  // segments
  std::vector<Index> of_edge;           // in the order of (vertex, larger neighbour); kNone for edges of faces
  std::vector<Index> of_vertex;  // the segment with most cells at it, the lower of equals; kNone for a lone vertex
};

// Sheets first, in the order of their first face; O(n log n).
MedialSegments medial_segments(const MedialAxis& axis, const SegmentOptions& options);

// The lines of an axis: borders of sheets, junctions where three or more of them meet, and curves. Nodes are their ends
// and where they meet or change; a closed line has a node of its own.
struct SkeletonGraph {
  enum class Kind : std::uint8_t { curve, border, junction };
  struct Arc {
    Index from = 0, to = 0;  // nodes
    Kind kind = Kind::curve;
    std::vector<Index> vertices;  // of the axis, ends included
    double length = 0;            // mesh units
    double mean_radius = 0;       // over the vertices
  };
  std::vector<Index> nodes;  // vertices of the axis, ascending
  std::vector<Arc> arcs;
};
SkeletonGraph skeleton_graph(const MedialAxis& axis);

// GraphML with x, y, z and radius of nodes, and kind, length and mean_radius of edges.
std::string to_graphml(const SkeletonGraph& graph, const MedialAxis& axis);

}  // namespace orchard
