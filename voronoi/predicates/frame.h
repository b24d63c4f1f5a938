#pragma once
#include <cmath>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The coordinates that diagrams are made in: moved to the middle of the points and scaled by a power of two, so that
// neither large offsets nor extreme sizes cost a digit, and the input's exact differences are the frame's, times that
// power. Along an axis on which the points are farther from the origin than three times their extent, the middle is
// taken off, which doubles do without rounding; along others nothing is.
class Frame {
 public:
  // For points of this box, which is that of a single point or of sizes within the limits: see checked_box().
  explicit Frame(const Box& box);

  // Of a coordinate, and of the longest side of the box. What users do with a diagram has room to spare then.
  static constexpr double kMax = 1e100, kMin = 1e-100;

  // Coordinates in the frame are below 4, and multiples of 2^-200: of what is smaller than 2^-148, the rest is dropped.
  Point inward(const Point& p) const { return {inward(p, 0), inward(p, 1), inward(p, 2)}; }
  Point outward(const Point& p) const { return p * unit_ + origin_; }
  double inward(double length) const { return length / unit_; }
  double outward(double length) const { return length * unit_; }

  // How far rounding to doubles may have moved an input coordinate, in the frame's units.
  double rounding() const { return rounding_; }

 private:
  double inward(const Point& p, int axis) const {
    constexpr double kQuantum = 0x1.8p-147;  // adding it rounds to multiples of 2^-199
    const double x = (p[axis] - origin_[axis]) / unit_;
    return std::abs(x) < 0x1p-148 ? (x + kQuantum) - kQuantum : x;
  }

  Vector origin_ = Vector::Zero();
  double unit_ = 1;  // a power of two
  double rounding_ = 0;
};

}  // namespace orchard::detail
