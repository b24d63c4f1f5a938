#pragma once
#include <array>

#include "math/exact_sign.h"

namespace orchard::runtime::detail {

using TrianglePoints = std::array<Vec3, 3>;

// Returns whether two closed triangles share a point. The result is exact for the given doubles, also for triangles
// that are coplanar, touch, or are degenerate to a segment or a point. If they do, and `witness` is not null, it is set
// to a common point, correct up to rounding.
bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b, Vec3* witness) noexcept;

}  // namespace orchard::runtime::detail
