#include "triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vector_functions.h"

namespace orchard::runtime::detail {
namespace {

// Sines below this count as parallel. At this sine the place on a line is known to 2 % and moves the distance by 2e-9
// of the length; below it, no place on the line is farther than 1e-7 of the length from the best one.
constexpr double kParallelSineSquare = 1e-14;

double unit(double part, double whole) noexcept { return whole > 0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

struct Best {
  double square = std::numeric_limits<double>::infinity();
  Vec3 p{}, q{};
  void offer(const Vec3& on_a, const Vec3& on_b) noexcept {
    const Vec3 d = minus(on_b, on_a);
    const double s = dot(d, d);
    if (s < square) square = s, p = on_a, q = on_b;
  }
};

// The best s for the line, then the best t for that s, then the best s for that t.
void edges(const Vec3& p, const Vec3& u, const Vec3& q, const Vec3& v, Best& best) noexcept {
  const Vec3 w = minus(p, q);
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > kParallelSineSquare * uu * vv ? std::clamp((uv * vw - uw * vv) / determinant, 0.0, 1.0) : 0;
  const double t = unit(uv * s + vw, vv);
  s = unit(uv * t - uw, uu);
  best.offer(along(p, u, s), along(q, v, t));
}

// Where a corner projects into the triangle; beside it an edge is nearer.
template <typename Offer>
void face(const Vec3& point, const TrianglePoints& t, const Vec3& normal, Offer&& offer) noexcept {
  const double square = dot(normal, normal);
  if (!(square > 0)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = t[i], &b = t[(i + 1) % 3];
    if (dot(cross(minus(b, a), minus(point, a)), normal) < 0) return;
  }
  offer(along(point, normal, dot(minus(t[0], point), normal) / square));
}

}  // namespace

double longest_edge(const TrianglePoints& t) noexcept {
  double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 e = minus(t[(i + 1) % 3], t[i]);
    square = std::max(square, dot(e, e));
  }
  return std::sqrt(square);
}

NearestPoints nearest_points(const TrianglePoints& a, const TrianglePoints& b) noexcept {
  Best best;
  const TrianglePoints ea = {minus(a[1], a[0]), minus(a[2], a[1]), minus(a[0], a[2])};
  const TrianglePoints eb = {minus(b[1], b[0]), minus(b[2], b[1]), minus(b[0], b[2])};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) edges(a[i], ea[i], b[j], eb[j], best);
  }
  const Vec3 na = cross(ea[0], ea[1]), nb = cross(eb[0], eb[1]);
  for (const Vec3& p : a) face(p, b, nb, [&](const Vec3& on_b) { best.offer(p, on_b); });
  for (const Vec3& p : b) face(p, a, na, [&](const Vec3& on_a) { best.offer(on_a, p); });
  return {std::sqrt(best.square), best.p, best.q};
}

NearestPoints nearest_points(const Vec3& point, const TrianglePoints& t) noexcept {
  Best best;
  const TrianglePoints edge = {minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
  for (std::size_t i = 0; i < 3; ++i) {
    best.offer(point, along(t[i], edge[i], unit(dot(minus(point, t[i]), edge[i]), dot(edge[i], edge[i]))));
  }
  face(point, t, cross(edge[0], edge[1]), [&](const Vec3& on_t) { best.offer(point, on_t); });
  return {std::sqrt(best.square), best.p, best.q};
}

NearestPoints nearest_points(const Vec3& p, const Vec3& q, const TrianglePoints& t) noexcept {
  Best best;
  const TrianglePoints edge = {minus(t[1], t[0]), minus(t[2], t[1]), minus(t[0], t[2])};
  const Vec3 way = minus(q, p);
  for (std::size_t i = 0; i < 3; ++i) {
    edges(p, way, t[i], edge[i], best);
    // Parallel ones, too, from each corner.
    best.offer(along(p, way, unit(dot(minus(t[i], p), way), dot(way, way))), t[i]);
    for (const Vec3& end : {p, q}) {
      best.offer(end, along(t[i], edge[i], unit(dot(minus(end, t[i]), edge[i]), dot(edge[i], edge[i]))));
    }
  }
  const Vec3 normal = cross(edge[0], edge[1]);
  for (const Vec3& end : {p, q}) face(end, t, normal, [&](const Vec3& on_t) { best.offer(end, on_t); });
  return {std::sqrt(best.square), best.p, best.q};
}

}  // namespace orchard::runtime::detail
