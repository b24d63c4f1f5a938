#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "orchard/geometry/mesh.h"

// The geometry of an insertion: computed in doubles, each result with a bound on its error, and exactly where that does
// not suffice. All points are taken relative to one of them, so that the error is proportional to the size of the
// tetrahedron and not to its distance from the origin.
namespace orchard::detail {

// Half a unit in the last place: the relative error of one rounding.
inline constexpr double kRounding = std::numeric_limits<double>::epsilon() / 2;

enum class Sign : int { negative = -1, uncertain = 0, positive = 1 };

inline Sign sign_of(double value, double bound) {
  return value > bound ? Sign::positive : value < -bound ? Sign::negative : Sign::uncertain;
}
inline Sign operator-(Sign sign) { return static_cast<Sign>(-static_cast<int>(sign)); }

// A determinant and a bound on its error.
struct Determinant {
  double value, bound;
  Sign sign() const { return sign_of(value, bound); }
};

// a . (b x c) for differences a, b, c of given points: 8 roundings of the sum of the absolute products bound the error
// (3 in the differences, 2 in the minors, 3 in the sum).
inline Determinant volume(const Vector& a, const Vector& b, const Vector& c) {
  const double yz = b.y() * c.z(), zy = b.z() * c.y(), zx = b.z() * c.x(), xz = b.x() * c.z(), xy = b.x() * c.y(),
               yx = b.y() * c.x();
  const double value = a.x() * (yz - zy) + a.y() * (zx - xz) + a.z() * (xy - yx);
  const double magnitude = std::abs(a.x()) * (std::abs(yz) + std::abs(zy)) +
                           std::abs(a.y()) * (std::abs(zx) + std::abs(xz)) +
                           std::abs(a.z()) * (std::abs(xy) + std::abs(yx));
  return {value, 8 * kRounding * magnitude};
}

// The sign of (a - q) . ((b - q) x (c - q)), or Sign::uncertain if the absolute value is not above `indifferent`. Exact
// for `indifferent` 0. Otherwise a value that is above `indifferent` by no more than a few dozen roundings of 2^-104
// may count as uncertain, too.
Sign volume_sign(const Point& q, const Point& a, const Point& b, const Point& c, double indifferent = 0);

// The exact sign with the middle of four points in place of q. Doubles need not represent that middle.
Sign volume_sign_of_middle(const std::array<Point, 4>& points, const Point& a, const Point& b, const Point& c);

// Whether p and q lie on the same side of the line through a and b, for four points in one plane. Exact.
Sign same_side_of_line(const Point& a, const Point& b, const Point& p, const Point& q);

// Whether q lies inside the sphere through four positively oriented points. Exact.
Sign inside_sphere(const Point& q, const Point& a, const Point& b, const Point& c, const Point& d);

// The circumcentre of q, a, b and c relative to q, accurate to a few roundings. Returns false if the points are
// coplanar, or so nearly that the centre overflows.
bool sharp_circumcenter(const Point& q, const Point& a, const Point& b, const Point& c, Vector& center);
// The same with an error of at most a hundredth, in down to a tenth of the time. Also returns false where twice the
// digits of doubles do not suffice.
bool rough_circumcenter(const Point& q, const Point& a, const Point& b, const Point& c, Vector& center);

// Bounds on the distance of a point from the circumcentre of q, a, b and c, in doubles: much faster than computing the
// circumcentre. The point is at most `off` away from it. The point minus `step` would be at most `rest` away, apart
// from the rounding of this difference. Both bounds are infinite where the sign of the volume is uncertain.
struct OffCenter {
  double off, rest;
  Vector step;
};
OffCenter off_circumcenter(const Point& center, const Point& q, const Point& a, const Point& b, const Point& c);
// The same, but the terms with the largest rounding errors are computed with more digits, so that `rest` is almost 0.
OffCenter sharply_off_circumcenter(const Point& center, const Point& q, const Point& a, const Point& b, const Point& c);

// The unit normal of the triangle q, a, b, accurate to a few roundings. Returns false if the points are collinear.
bool sharp_normal(const Point& q, const Point& a, const Point& b, Vector& normal);

// The circumcentre of the origin, a, b and c.
struct RelativeCenter {
  Vector center;     // meaningless where the condition is infinite or not a number
  double volume6;    // a . (b x c): six times the signed volume
  double condition;  // |a||b||c| / |volume6| >= 1: round-off is magnified this many times
  double max_face;   // twice the area of the largest of the three faces at the origin

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
