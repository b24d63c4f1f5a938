#pragma once
#include "math/triangle_pair.h"

namespace orchard::runtime::detail {

struct NearestPoints {
  double distance;
  Vec3 on_a, on_b;
};

// The distance of two triangles that do not intersect, degenerate ones included, and where. The points are on the
// triangles and `distance` apart, both up to rounding in double; nearly parallel edges can make that distance larger
// than the true one, by at most kParallelError times the sum of the triangles' longest edges.
inline constexpr double kParallelError = 2e-7;
NearestPoints nearest_points(const TrianglePoints& a, const TrianglePoints& b) noexcept;

// Of a triangle from a segment that it does not intersect, or a point: as above, `on_a` being on the segment.
NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept;

double longest_edge(const TrianglePoints& t) noexcept;

}  // namespace orchard::runtime::detail
