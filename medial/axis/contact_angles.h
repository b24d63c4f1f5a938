#pragma once
#include "orchard/medial/axis.h"

namespace orchard::detail {

// Returns the angle at which two points are seen from `from`, but at most the angle between the surface normals at the
// points. Four points that nearly share a circle on the surface may have their Voronoi vertex anywhere above it, even
// right beside it; from there they are seen at a large angle although the surface does not turn between them.
double seen_angle(const MedialAxis& axis, const Point& from, Index p, Index q);

// Fills axis.angles. At edges and in creases the bound by normals is weak, and vertices next to the surface would pass
// for places between two opposite sides of the solid. So the contact that each forming point stands for is searched:
// from the point downhill on the distance from the vertex, over the surface, to a local minimum. The angle of a pair of
// points is the smallest of three: the angle at which the points are seen, the one that the normals allow, and the
// angle at which the contacts are seen. Precondition: all other members of the axis are set. Parallel; O(1) for each
// vertex.
void find_contact_angles(const Surface& surface, const SurfaceSampling& sampling, MedialAxis& axis);

}  // namespace orchard::detail
