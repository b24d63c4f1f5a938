#pragma once
#include <array>
#include <cmath>

#include "orchard/geometry/mesh.h"

// Signs of determinants of coordinates, exact for any finite doubles. They are evaluated in doubles if Shewchuk's error
// bounds (1997) prove the sign, else in rational numbers.
namespace orchard::detail {

int exact_line_side(const std::array<double, 2>& p, const std::array<double, 2>& r, const std::array<double, 2>& q);
int exact_plane_side(const std::array<Point, 3>& t, const Point& q);

constexpr double kUnit = 0x1p-53;
constexpr double kLineError = (3 + 16 * kUnit) * kUnit, kPlaneError = (7 + 56 * kUnit) * kUnit;
constexpr double kUnderflow = 1e-280;  // products below it may have lost digits, so that the bounds do not hold

inline int sign_of(double x) { return (x > 0) - (x < 0); }

// The sign of the area of triangle (p, r, q) in the coordinates u and v: +1 if q lies to the left of the way from p to
// r.
inline int line_side(const Point& p, const Point& r, const Point& q, int u, int v) {
  const double left = (r[u] - p[u]) * (q[v] - p[v]), right = (r[v] - p[v]) * (q[u] - p[u]);
  const double determinant = left - right, bound = kLineError * (std::fabs(left) + std::fabs(right)) + kUnderflow;
  if (std::fabs(determinant) > bound) return sign_of(determinant);
  return exact_line_side({p[u], p[v]}, {r[u], r[v]}, {q[u], q[v]});
}

// On which side of the triangle's plane q lies: +1 in front, where the corners run counter-clockwise.
inline int plane_side(const std::array<Point, 3>& t, const Point& q) {
  const Vector b = t[1] - t[0], c = t[2] - t[0], d = q - t[0];
  const std::array<double, 6> products{b.y() * c.z(), b.z() * c.y(), b.z() * c.x(),
                                       b.x() * c.z(), b.x() * c.y(), b.y() * c.x()};
  const double determinant =
      d.x() * (products[0] - products[1]) + d.y() * (products[2] - products[3]) + d.z() * (products[4] - products[5]);
  const double size = std::fabs(d.x()) * (std::fabs(products[0]) + std::fabs(products[1])) +
                      std::fabs(d.y()) * (std::fabs(products[2]) + std::fabs(products[3])) +
                      std::fabs(d.z()) * (std::fabs(products[4]) + std::fabs(products[5]));
  if (std::fabs(determinant) > kPlaneError * size + kUnderflow) return sign_of(determinant);
  return exact_plane_side(t, q);
}

}  // namespace orchard::detail
