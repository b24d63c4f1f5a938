#pragma once
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime::detail {

// nearest_point_to_segment() for callers that ask many times.
struct NearestToSegment {
  SurfacePoint point;
  double beyond = 0;  // where there is no point: how far the surface is from the segment, at least
};

// `guess`, a triangle of the tree or kNoTriangle, is looked at first: where it is near, the nearest one is found
// sooner. Of several that meet the segment, the guess is named. Precondition: the pose is rigid.
NearestToSegment nearest_to_segment(const TreeView& tree, const Pose& pose, const Vec3& p, const Vec3& q, double limit,
                                    std::uint32_t guess) noexcept;

}  // namespace orchard::runtime::detail
