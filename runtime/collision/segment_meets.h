#pragma once
#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

// Returns whether a closed segment and a closed triangle share a point. The result is exact, and the same as that of
// triangles_intersect() for the segment as a degenerate triangle. If they do, `common` is the first such point on the
// segment, up to rounding.
bool segment_meets(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept;

// Does the same for a segment whose line certainly passes through the inside of the triangle.
bool segment_passes(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept;

}  // namespace orchard::runtime::detail
