#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/geometry/mesh.h"

// The geometry of an insertion in plain doubles, every result with what is needed to judge it. All points are taken
// relative to one of them, which keeps the error proportional to the tetrahedron and not to its distance from the
// origin.
namespace orchard::detail {

// Half a unit in the last place: the relative error of one rounding.
inline constexpr double kRounding = std::numeric_limits<double>::epsilon() / 2;

enum class Sign : int { negative = -1, uncertain = 0, positive = 1 };

inline Sign sign_of(double value, double bound) {
  return value > bound ? Sign::positive : value < -bound ? Sign::negative : Sign::uncertain;
}

// The sign of a . (b x c), beyond the round-off of differences a, b, c of given points: 8 roundings of the sum of the
// absolute products (3 in the differences, 2 in the minors, 3 in the sum).
inline Sign volume_sign(const Vector& a, const Vector& b, const Vector& c) {
  const double yz = b.y() * c.z(), zy = b.z() * c.y(), zx = b.z() * c.x(), xz = b.x() * c.z(), xy = b.x() * c.y(),
               yx = b.y() * c.x();
  const double value = a.x() * (yz - zy) + a.y() * (zx - xz) + a.z() * (xy - yx);
  const double magnitude = std::abs(a.x()) * (std::abs(yz) + std::abs(zy)) +
                           std::abs(a.y()) * (std::abs(zx) + std::abs(xz)) +
                           std::abs(a.z()) * (std::abs(xy) + std::abs(yx));
  return sign_of(value, 8 * kRounding * magnitude);
}

// Whether the query lies inside the sphere through four positively oriented points, given relative to the query.
// The lifted determinant, expanded by the lifts; 16 roundings of the sum of the absolute products bound its error.
inline Sign inside_sphere(const Vector& a, const Vector& b, const Vector& c, const Vector& d) {
  struct Minor {
    double value, magnitude;
  };
  const auto minor2 = [](const Vector& u, const Vector& v) {
    const double p = u.x() * v.y(), q = v.x() * u.y();
    return Minor{p - q, std::abs(p) + std::abs(q)};
  };
  const Minor ab = minor2(a, b), bc = minor2(b, c), cd = minor2(c, d), da = minor2(d, a), ac = minor2(a, c),
              bd = minor2(b, d);
  const double az = std::abs(a.z()), bz = std::abs(b.z()), cz = std::abs(c.z()), dz = std::abs(d.z());
  const double abc = a.z() * bc.value - b.z() * ac.value + c.z() * ab.value;
  const double bcd = b.z() * cd.value - c.z() * bd.value + d.z() * bc.value;
  const double cda = c.z() * da.value + d.z() * ac.value + a.z() * cd.value;
  const double dab = d.z() * ab.value + a.z() * bd.value + b.z() * da.value;
  const double aa = a.squaredNorm(), bb = b.squaredNorm(), cc = c.squaredNorm(), dd = d.squaredNorm();
  const double value = (cc * dab - dd * abc) + (aa * bcd - bb * cda);
  const double magnitude = aa * (bz * cd.magnitude + cz * bd.magnitude + dz * bc.magnitude) +
                           bb * (cz * da.magnitude + dz * ac.magnitude + az * cd.magnitude) +
                           cc * (dz * ab.magnitude + az * bd.magnitude + bz * da.magnitude) +
                           dd * (az * bc.magnitude + bz * ac.magnitude + cz * ab.magnitude);
  return sign_of(value, 16 * kRounding * magnitude);
}

// The circumcentre of the origin, a, b and c.
struct RelativeCenter {
  Vector center;        // meaningless where the condition is infinite or not a number
  double volume6;       // a . (b x c): six times the signed volume
  double condition;     // |a||b||c| / |volume6| >= 1: round-off is magnified this many times
  double largest_face;  // twice the area of the largest of the three faces at the origin

  // Every error term of the determinants is a few roundings times |a||b||c| (times a length <= the diameter), so the
  // centre is off by at most kCenterError * condition * radius.
  static constexpr double kCenterError = 64 * kRounding;
  bool reliable() const { return condition * kCenterError < 0.125; }
};

struct LengthedVector {
  Vector vector;
  double squared, length;

  explicit LengthedVector(const Vector& v = Vector::Zero())
      : vector(v), squared(v.squaredNorm()), length(std::sqrt(squared)) {}
};

inline RelativeCenter circumcenter(const LengthedVector& a, const LengthedVector& b, const LengthedVector& c) {
  const Vector bc = b.vector.cross(c.vector), ca = c.vector.cross(a.vector), ab = a.vector.cross(b.vector);
  const double volume6 = a.vector.dot(bc);
  const Vector numerator = a.squared * bc + b.squared * ca + c.squared * ab;
  return {numerator * (0.5 / volume6), volume6, a.length * b.length * c.length / std::abs(volume6),
          std::sqrt(std::max({bc.squaredNorm(), ca.squaredNorm(), ab.squaredNorm()}))};
}

}  // namespace orchard::detail
