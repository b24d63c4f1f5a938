#pragma once
#include "orchard/medial/axis.h"

namespace orchard::detail {

// The angle at which two points are seen from `from`, but no more than the surface's normals there are apart: four
// points that all but share a circle on the surface may have their Voronoi vertex anywhere above it, even next to it,
// and are seen widely apart from there though the surface does not turn between them.
double seen_angle(const MedialAxis& axis, const Point& from, Index p, Index q);

// Fills axis.angles. At edges and in creases the normals' bound says little, and vertices next to the surface, with
// points around them on what is one side for them, would pass for places between two sides of the solid. So from each
// forming point the contact is sought that it stands for: downhill on the distance from the vertex, over the surface,
// to where that has a local minimum. A pair of points is as wide as it is seen, as the normals allow, and as its
// contacts are seen. Precondition: all else of the axis is there. Parallel; O(1) for each vertex.
void find_contact_angles(const Surface& surface, const SurfaceSampling& sampling, MedialAxis& axis);

}  // namespace orchard::detail
