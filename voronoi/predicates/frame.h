#pragma once
#include <cmath>

#include "orchard/geometry/mesh.h"

namespace orchard::detail {

// The coordinates in which diagrams are built. Points are moved to the middle of their box and scaled by a power of
// two, so that neither large offsets nor extreme sizes cost precision. Differences of coordinates are exactly those of
// the input times that power. The middle is subtracted only along axes on which the points are farther from the origin
// than three times their extent, where doubles subtract without rounding.
class Frame {
 public:
  // The box has to be that of a single point, or to have a size within the limits (see checked_box()).
  explicit Frame(const Box& box);

  // Limits of a coordinate, and of the longest side of the box. They leave room for the computations that applications
  // make with a diagram.
  static constexpr double kMax = 1e100, kMin = 1e-100;

  // Coordinates in the frame are below 4 and are multiples of 2^-200. Digits below 2^-148 are dropped.
  Point inward(const Point& p) const { return {inward(p, 0), inward(p, 1), inward(p, 2)}; }
  Point outward(const Point& p) const { return p * unit_ + origin_; }
  double inward(double length) const { return length / unit_; }
  double outward(double length) const { return length * unit_; }

  // Returns how far rounding to doubles may have moved an input coordinate, in units of the frame.
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
