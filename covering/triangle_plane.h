#pragma once
#include <array>

#include "circle_intervals.h"
#include "orchard/geometry/mesh.h"

namespace orchard::detail {

using Point2 = Eigen::Vector2d;

// A bound on the rounding error of any comparison in the boundary lemma, as a multiple of the lengths involved. A
// comparison is a handful of operations with an error of 2^-53 each, so 2^-46 leaves a factor of ten.
inline constexpr double kRounding = 0x1p-46;

// A disk in the triangle's plane that is certainly inside its ball. radius <= 0: dropped.
struct Disk {
  Point2 center = Point2::Zero();
  double radius = -1;
  bool holds_region = false;  // certainly
  double fuzz = 0;            // bound on the rounding errors of comparisons with it
};

// The region that has to be covered: a triangle, or the part of it inside a ball, in either case slightly enlarged. It
// is convex. Its plane has coordinates around the triangle's first corner, so that an offset of the whole model costs
// no accuracy. The part of a circle inside the region is rounded outward; the part of a circle inside another disk is
// rounded inward.
class TrianglePlane {
 public:
  explicit TrianglePlane(const std::array<Point, 3>& triangle);
  TrianglePlane(const std::array<Point, 3>& triangle, const Sphere& clip);

  bool empty() const { return empty_; }                 // certainly
  const Point2& named_point() const { return named_; }  // a point of the region

  Disk project(const Point& center, double radius) const;
  void clip_to_region(const Disk& disk, CircleIntervals& needed) const;  // what of its circle lies in the region
  Arc inside_of(const Disk& circle, const Disk& other) const;  // what of the circle lies in the other's interior
  bool certainly_inside(const Point2& point, const Disk& disk) const;
  Eigen::AlignedBox2d box() const;
  Point lift(const Point2& p) const { return origin_ + p.x() * x_axis_ + p.y() * y_axis_; }

 private:
  struct HalfPlane {
    Point2 normal;  // normal . x <= offset
    double angle;   // of the normal
    double offset;
  };
  void make_frame(const std::array<Point, 3>& triangle);
  void make_sides();
  void clip_to_ball(const std::array<Point, 3>& triangle, const Sphere& clip);
  Point2 flatten(const Point& p) const { return {(p - origin_).dot(x_axis_), (p - origin_).dot(y_axis_)}; }
  double rounding(const Point2& center, double radius) const { return kRounding * (center.norm() + radius + extent_); }
  double slack(const Vector& offset, double radius) const { return kRounding * (offset.norm() + radius + extent_); }
  bool holds_region(const Disk& disk, double fuzz) const;

  Point origin_;
  Vector x_axis_, y_axis_, normal_;
  std::array<Point2, 3> corners_;
  std::array<HalfPlane, 5> sides_;  // the triangle's, and a box for the ends of needles, whose sides are near parallel
  Point2 centroid_, named_;
  double extent_ = 0;  // of the coordinates
  double size_ = 0;    // distance of the farthest corner from the centroid
  Disk clip_;          // certainly holds the clipping ball's disk; radius < 0: none
  bool empty_ = false;
};

}  // namespace orchard::detail
