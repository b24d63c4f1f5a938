#pragma once
#include <array>

#include "math/exact_sign.h"

namespace orchard::runtime::detail {

using TrianglePoints = std::array<Vec3, 3>;

// Whether two closed triangles share a point: exact for the doubles given, be they coplanar, touching, or degenerate to
// a segment or a point. If so, and `witness` is not null, it gets a common point, correct up to rounding.
bool triangles_intersect(const TrianglePoints& a, const TrianglePoints& b, Vec3* witness) noexcept;

}  // namespace orchard::runtime::detail
