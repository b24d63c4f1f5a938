#pragma once
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime::detail {

// nearest_point_to_segment(), which is found sooner where `guess` is near it: a triangle of the tree, or kNoTriangle.
SurfacePoint nearest_point_to_segment(const TreeView& tree, const Pose& pose, const std::array<double, 3>& p,
                                      const std::array<double, 3>& q, double limit, std::uint32_t guess) noexcept;

}  // namespace orchard::runtime::detail
