#pragma once
#include <span>
#include <vector>

#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/medial/importance.h"

// Removes the insignificant parts of a medial axis, such as the spurs that noise on the surface causes.
namespace orchard {

// The options of prune(): for each measure of importance.h, the value below which places are removed. If several values
// are set, a place is removed if it is below one of them. The defaults remove nothing; larger values remove more.
struct PruneOptions {
  double angle = 0;  // In radians, in [0, pi]. Foskey, Lin, Manocha 2003 call it the separation angle.
  double scale = 1;  // A factor, at least 1.
  // At least 0, as fractions of the diagonal of the surface's bounding box.
  double border_loss = 0, lambda = 0, erosion = 0, geodesic = 0;

  bool removes_nothing() const {
    return angle == 0 && scale == 1 && border_loss == 0 && lambda == 0 && erosion == 0 && geodesic == 0;
  }
};

// Removes faces from their free edges and edges from their free ends, the least significant first. All removals are
// elementary collapses, so the result has the topology of `axis` for all options (as in Sud, Foskey, Manocha 2005).
// A part that the options select stays if it has no free edge or end.
// The triangles of a refined axis are cut along the line on which the measure has the given value, at exact balls; the
// measure is interpolated linearly in between. The polygons of a Voronoi diagram and the triangles of an imported axis
// are removed as a whole: for `angle`, if their two points are seen at a smaller angle; for `lambda`, if these points
// are less than 2 lambda apart; and for the other measures, if the value of a corner is below the limit. Throws
// InputError if an option is out of range. Deterministic. O(n log n), and the cost of importance().
MedialAxis prune(const Surface& surface, const MedialAxis& axis, const PruneOptions& options,
                 const Progress& progress = {});

// Does the same for one measure whose values are known: `values` are importance(surface, axis, measure), and `limit` is
// in their unit. For several limits, the measure is thus computed once.
MedialAxis prune(const Surface& surface, const MedialAxis& axis, ImportanceMeasure measure,
                 const std::vector<double>& values, double limit);

// Returns the member of `options` that belongs to a measure.
double& limit_of(PruneOptions& options, ImportanceMeasure measure);

// Returns the angle in radians at which the two points of a face or topology face are seen from its middle, but at most
// the angle between the surface normals at the points and at most the largest angle of the face's vertices. The limits
// matter for faces close to the surface, which slivers of the point set cause: without them, such faces would seem to
// lie between two opposite sides of the solid. If the axis has no `turns` and no `angles`, there are no limits.
double separation_angle(const MedialAxis& axis, std::span<const Index> face, const std::array<Index, 2>& points);

// Returns axis.angles. For an axis without them, returns for each vertex the widest angle between two forming points,
// seen from the vertex.
std::vector<double> contact_angles(const MedialAxis& axis);

}  // namespace orchard
