#pragma once
#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

// Whether a closed segment and a closed triangle share a point: exactly, as triangles_intersect() says of the segment
// as a triangle. If so, `common` is the first such point, up to rounding.
bool segment_meets(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept;

// The same where the segment's line certainly runs through the triangle's inside.
bool segment_passes(const Vec3& from, const Vec3& to, const TrianglePoints& t, Vec3& common) noexcept;

}  // namespace orchard::runtime::detail
