#pragma once
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime::detail {

// The result of nearest_to_segment().
struct NearestToSegment {
  SurfacePoint point;
  double beyond = 0;  // if there is no point: a lower bound on the distance of the surface from the segment
};

// Does the same as nearest_point_to_segment(), for callers that ask many times. `guess`, a triangle of the tree or
// kNoTriangle, is tested first: if it is near, the search is faster. If several triangles meet the segment and one of
// them is the guess, it is the result. Precondition: the pose is rigid.
NearestToSegment nearest_to_segment(const TreeView& tree, const Pose& pose, const Vec3& p, const Vec3& q, double limit,
                                    std::uint32_t guess) noexcept;

}  // namespace orchard::runtime::detail
