#pragma once
#include <span>
#include <vector>

#include "orchard/medial/axis.h"

namespace orchard {

// What is cut off a medial axis. Noise of the surface grows spurs on the axis; both rules remove them.
struct PruneOptions {
  // Radians in [0, pi]: cells whose forming points are seen at less than this from their middle (the separation angle
  // lambda of Foskey, Lin, Manocha 2003; twice the object angle). 0 prunes nothing.
  double angle = 0;
  // At least 1: vertices whose ball, enlarged so many times, lies in another vertex's enlarged ball (the scale axis of
  // Giesen, Miklos, Pauly, Wormser 2009). 1 prunes nothing.
  double scale = 1;
};

// Removes faces from their free edges, and edges from their free ends, the smallest angles first: elementary
// collapses, so that whatever the options the result has the topology of `axis` (as Sud, Foskey, Manocha 2005). A cell
// that is to go but has nothing free stays. O(n log n). Throws InputError for options out of range.
MedialAxis prune(const MedialAxis& axis, const PruneOptions& options);

// The angle at which the two points of a face (or wall) are seen from its middle, in radians; at most that between the
// surface's normals there, and at most that of the face's widest vertex, so that faces that slivers of the point set
// put next to the surface do not pass for places between two walls. An axis without `turns` and `angles` is judged by
// the positions alone.
double separation_angle(const MedialAxis& axis, std::span<const Index> face, const std::array<Index, 2>& points);

// axis.angles; for an axis without them, the widest such angle between two forming points of each vertex, seen from it.
std::vector<double> contact_angles(const MedialAxis& axis);

}  // namespace orchard
