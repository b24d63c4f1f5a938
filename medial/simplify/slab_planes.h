#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "contractible_mesh.h"

namespace orchard::detail {

// A sum of weighted squared distances of a ball from planes that it should touch: x A x - 2 b x + c.
struct Quadric {
  Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
  Ball4 b = Ball4::Zero();
  double c = 0;

  Quadric& operator+=(const Quadric& other) {
    a += other.a;
    b += other.b;
    c += other.c;
    return *this;
  }
  // Adds the plane with this outward normal that the ball `on` touches.
  void add_plane(const Vector& normal, const Ball4& on, double weight) {
    Ball4 row;
    row << normal, 1;
    const double side = row.dot(on);
    a += weight * row * row.transpose();
    b += weight * side * row;
    c += weight * side * side;
  }
  double at(const Ball4& x) const { return std::max(0.0, x.dot(a * x) - 2 * b.dot(x) + c); }
  double weight() const { return a(3, 3); }  // of all planes, whose rows end in 1
};

// A unit vector at right angles to `unit`.
inline Vector across(const Vector& unit) {
  Vector other = Vector::Zero();
  Index axis = 0;
  for (Index k = 1; k < 3; ++k) {
    if (std::abs(unit[k]) < std::abs(unit[axis])) axis = k;
  }
  other[axis] = 1;
  return unit.cross(other).normalized();
}

// The cone that touches two balls. `out` is a unit vector at right angles to `unit`: the plane that touches both balls
// on that side has the normal `normal(out)`.
struct Cone {
  Ball4 a, b;
  Vector unit = Vector::Zero();  // from a to b
  double length = 0, slope = 0;  // a length of 0: no cone

  Cone(const Ball4& first, const Ball4& second) : a(first), b(second) {
    const Vector along = (b - a).head<3>();
    length = along.norm();
    if (!(length > 0)) return;
    unit = along / length;
    slope = (b[3] - a[3]) / length;
  }
  Vector normal(const Vector& out) const { return std::sqrt(1 - slope * slope) * out - slope * unit; }
};

}  // namespace orchard::detail
