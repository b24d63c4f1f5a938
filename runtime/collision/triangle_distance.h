#pragma once
#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

struct NearestPoints {
  double distance;
  Vec3 on_a, on_b;
};

inline constexpr double kParallelError = 2e-7;
// Returns the distance of two triangles and their nearest points. The triangles must not intersect, and may be
// degenerate. The points are on the triangles and `distance` apart, both up to rounding in double. If edges are nearly
// parallel, `distance` may exceed the true one by at most kParallelError times the sum of the longest edges of both
// triangles.
NearestPoints nearest_points(const TrianglePoints& a, const TrianglePoints& b) noexcept;

// Does the same for a triangle and the segment from p to q, which may be a point. `on_a` is on the segment.
NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept;

double longest_edge(const TrianglePoints& t) noexcept;

}  // namespace orchard::runtime::detail
