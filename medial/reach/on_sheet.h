#pragma once
#include "../quality/reconstruction.h"
#include "orchard/geometry/surface.h"

namespace orchard::detail {

// Returns whether a triangle from the edge pq of an axis to a new vertex would lie on a sheet that is there already. A
// place on a face of the surface has only one ball of the axis that touches it. So if the place that the ball in the
// middle of the triangle touches is touched by a ball of the axis near this middle, the triangle adds nothing: it lies
// on the sheet of that ball, or it crosses sheets. O(log n).
bool lies_on_sheet(const Surface& surface, const Reconstruction& axis, const Point& p, const Point& q,
                   const Point& vertex);

}  // namespace orchard::detail
