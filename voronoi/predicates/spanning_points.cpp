#include "predicates/spanning_points.h"

#include <cmath>

#include "predicates/predicates.h"

namespace orchard::detail {

std::array<Index, 4> spanning_points(std::span<const Point> points) {
  const auto farthest = [&](auto&& distance) {
    Index best = 0;
    double best_distance = -1;
    for (Index i = 0; i < points.size(); ++i) {
      const double d = distance(points[i]);
      if (d > best_distance) best = i, best_distance = d;
    }
    return best;
  };
  const Index a = 0;
  const Point& origin = points[a];
  const Index b = farthest([&](const Point& p) { return (p - origin).squaredNorm(); });
  const Vector along = points[b] - origin;
  const Index c = farthest([&](const Point& p) { return (p - origin).cross(along).squaredNorm(); });
  const Vector normal = along.cross(points[c] - origin);
  const Index d = farthest([&](const Point& p) { return std::abs((p - origin).dot(normal)); });
  return {a, b, c, d};
}

int affine_dimension(std::span<const Point> points) {
  if (points.empty()) return 0;
  const auto [a, b, c, d] = spanning_points(points);
  const Point &p = points[a], &q = points[b], &r = points[c];
  if (p == q) return 0;
  Vector normal;
  if (!sharp_normal(p, q, r, normal)) return 1;
  return volume_sign(p, q, r, points[d]) == Sign::uncertain ? 2 : 3;
}

}  // namespace orchard::detail
