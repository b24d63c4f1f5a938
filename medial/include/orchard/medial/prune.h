#pragma once
#include <span>
#include <vector>

#include "orchard/medial/axis.h"

// Removes the spurs of a medial axis that noise on the surface causes.
namespace orchard {

// The options of prune(). Both rules remove spurs. The defaults remove nothing.
struct PruneOptions {
  // The separation angle in radians, in [0, pi]. Cells whose forming points are seen from the middle of the cell at a
  // smaller angle are removed (the angle lambda of Foskey, Lin, Manocha 2003; twice the object angle). Larger values
  // remove more.
  double angle = 0;
  // The scale factor, at least 1. Vertices whose ball, enlarged by this factor, lies in another vertex's enlarged ball
  // are removed (the scale axis of Giesen, Miklos, Pauly, Wormser 2009). Larger values remove more.
  double scale = 1;
};

// Removes faces from their free edges and edges from their free ends, the smallest angles first. All removals are
// elementary collapses, so the result has the topology of `axis` for all options (as in Sud, Foskey, Manocha 2005). A
// cell that the options select but that has no free side stays. Throws InputError if an option is out of range. O(n log
// n).
MedialAxis prune(const MedialAxis& axis, const PruneOptions& options);

// Returns the angle in radians at which the two points of a face or topology face are seen from its middle, but at most
// the angle between the surface normals at the points and at most the largest angle of the face's vertices. The limits
// matter for faces close to the surface, which slivers of the point set cause: without them, such faces would seem to
// lie between two opposite sides of the solid. If the axis has no `turns` and no `angles`, there are no limits.
double separation_angle(const MedialAxis& axis, std::span<const Index> face, const std::array<Index, 2>& points);

// Returns axis.angles. For an axis without them, returns for each vertex the widest angle between two forming points,
// seen from the vertex.
std::vector<double> contact_angles(const MedialAxis& axis);

}  // namespace orchard
