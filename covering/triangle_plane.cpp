#include "triangle_plane.h"

#include <algorithm>
#include <cmath>

#include "orchard/geometry/surface.h"

namespace orchard::detail {
namespace {

const Point& corner(const std::array<Point, 3>& triangle, int i) { return triangle[static_cast<std::size_t>(i % 3)]; }

Vector unit_or(const Vector& v, const Vector& otherwise) {
  const double length = v.stableNorm();
  return length > 0 ? Vector(v / length) : otherwise;
}

// Returns the arc of a circle of radius r inside a disk of radius s whose centre is `apart` away. If t is half the
// angle of the arc, then tan^2(t/2) = (s^2 - (D - r)^2) / ((D + r)^2 - s^2). In this form, a rounding error moves the
// ends of the arc by no more than it moves the distance of the circles there, even near tangency.
Arc arc_inside(const Point2& apart, double r, double s) {
  const double distance = apart.norm();
  const double above = (s - (distance - r)) * (s + (distance - r));
  const double below = (distance + r - s) * (distance + r + s);
  if (below <= 0) return Arc::all();
  if (above <= 0) return Arc::none();
  return Arc::around(std::atan2(apart.y(), apart.x()), 2 * std::atan2(std::sqrt(above), std::sqrt(below)));
}

}  // namespace

TrianglePlane::TrianglePlane(const std::array<Point, 3>& triangle) {
  make_frame(triangle);
  for (std::size_t i = 0; i < 3; ++i) corners_[i] = flatten(triangle[i]);
  make_sides();
  named_ = centroid_;
}

TrianglePlane::TrianglePlane(const std::array<Point, 3>& triangle, const Sphere& clip) : TrianglePlane(triangle) {
  clip_to_ball(triangle, clip);
}

void TrianglePlane::make_frame(const std::array<Point, 3>& triangle) {
  int longest = 0;
  double best = -1;
  for (int i = 0; i < 3; ++i) {
    const double length = (corner(triangle, i + 1) - corner(triangle, i)).squaredNorm();
    if (length > best) best = length, longest = i;
  }
  origin_ = corner(triangle, longest);
  x_axis_ = unit_or(corner(triangle, longest + 1) - origin_, Vector::UnitX());
  // The vector is made orthogonal twice. The third corner of a needle is almost along the first axis, so a single pass
  // would leave a slanted frame.
  Vector across = corner(triangle, longest + 2) - origin_;
  across -= across.dot(x_axis_) * x_axis_;
  across -= across.dot(x_axis_) * x_axis_;
  y_axis_ = unit_or(across, x_axis_.unitOrthogonal());
  y_axis_ = (y_axis_ - y_axis_.dot(x_axis_) * x_axis_).normalized();
  normal_ = x_axis_.cross(y_axis_);
}

void TrianglePlane::make_sides() {
  const double turn = (corners_[1] - corners_[0]).x() * (corners_[2] - corners_[0]).y() -
                      (corners_[1] - corners_[0]).y() * (corners_[2] - corners_[0]).x();
  if (turn < 0) std::swap(corners_[1], corners_[2]);
  centroid_ = (corners_[0] + corners_[1] + corners_[2]) / 3;
  for (const Point2& c : corners_) {
    extent_ = std::max(extent_, c.norm());
    size_ = std::max(size_, (c - centroid_).norm());
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Point2 along = corners_[(i + 1) % 3] - corners_[i];
    const double length = along.norm();
    const Point2 normal = length > 0 ? Point2(along.y() / length, -along.x() / length) : Point2(0, 1);
    // The outermost corner decides, so that rounding of the normal never cuts a corner off.
    double offset = normal.dot(corners_[0]);
    for (const Point2& c : corners_) offset = std::max(offset, normal.dot(c));
    sides_[i] = {normal, std::atan2(normal.y(), normal.x()), offset};
  }
  sides_[3] = {Point2(1, 0), 0, box().max().x()};
  sides_[4] = {Point2(-1, 0), kTwoPi / 2, -box().min().x()};
}

Eigen::AlignedBox2d TrianglePlane::box() const {
  Eigen::AlignedBox2d box;
  for (const Point2& c : corners_) box.extend(c);
  return box;
}

// The clipping disk is larger than that of the ball by a margin for all rounding errors, so the region contains
// everything that is needed. The named point is the point of the triangle nearest to the ball's centre.
void TrianglePlane::clip_to_ball(const std::array<Point, 3>& triangle, const Sphere& clip) {
  const ClosestPoint nearest = closest_point_of_triangle(clip.center, triangle[0], triangle[1], triangle[2]);
  const Vector offset = clip.center - origin_;
  const double grown = slack(offset, clip.radius), radius = clip.radius + grown;
  empty_ = nearest.distance > radius;
  if (empty_) return;
  named_ = flatten(nearest.position);
  const double height = std::max(0.0, std::abs(offset.dot(normal_)) - grown);
  clip_.center = {offset.dot(x_axis_), offset.dot(y_axis_)};
  clip_.radius = std::sqrt(std::max(0.0, (radius - height) * (radius + height))) + grown;
  // If the triangle lies inside, clipping changes nothing, and the middle of the triangle is the better named point.
  const bool idle = std::all_of(corners_.begin(), corners_.end(),
                                [&](const Point2& c) { return (c - clip_.center).norm() <= clip_.radius; });
  if (idle) clip_ = {}, named_ = centroid_;
}

// The ball is shrunk by a margin for the rounding errors of the frame, of the projection and of the triangle's distance
// from the plane of the frame. So every point of the triangle in the disk is in the ball.
Disk TrianglePlane::project(const Point& center, double ball_radius) const {
  Disk disk;
  const Vector offset = center - origin_;
  const double shrunk = slack(offset, ball_radius);
  const double radius = ball_radius - shrunk;
  const double height = std::abs(offset.dot(normal_)) + shrunk;
  if (!(radius > height)) return disk;
  disk.center = {offset.dot(x_axis_), offset.dot(y_axis_)};
  const double in_plane = std::sqrt((radius - height) * (radius + height));
  disk.fuzz = rounding(disk.center, in_plane);
  if ((disk.center - centroid_).norm() > in_plane + size_ + disk.fuzz) return disk;
  disk.radius = in_plane;
  disk.holds_region = holds_region(disk, disk.fuzz);
  return disk;
}

bool TrianglePlane::holds_region(const Disk& disk, double fuzz) const {
  if (clip_.radius > 0 && (disk.center - clip_.center).norm() + clip_.radius <= disk.radius - 2 * fuzz) return true;
  return std::all_of(corners_.begin(), corners_.end(),
                     [&](const Point2& c) { return (c - disk.center).norm() <= disk.radius - fuzz; });
}

bool TrianglePlane::certainly_inside(const Point2& point, const Disk& disk) const {
  return (point - disk.center).norm() <= disk.radius - disk.fuzz;
}

void TrianglePlane::clip_to_region(const Disk& disk, CircleIntervals& needed) const {
  const double fuzz = disk.fuzz;
  needed.set_all();
  for (const HalfPlane& side : sides_) {
    const double room = side.offset + fuzz - side.normal.dot(disk.center);
    if (room >= disk.radius) continue;
    if (room <= -disk.radius) return needed.clear();
    const double half = 2 * std::atan2(std::sqrt(disk.radius - room), std::sqrt(disk.radius + room));
    needed.subtract(Arc::around(side.angle, half));
    if (needed.empty()) return;
  }
  if (clip_.radius <= 0) return;
  const double wide = clip_.radius + fuzz + rounding(clip_.center, clip_.radius);
  CircleIntervals inside;
  inside.assign_intersection(needed, arc_inside(clip_.center - disk.center, disk.radius, wide));
  needed = inside;
}

Arc TrianglePlane::inside_of(const Disk& circle, const Disk& other) const {
  const double s = other.radius - circle.fuzz - other.fuzz;
  if (s <= 0) return Arc::none();
  return arc_inside(other.center - circle.center, circle.radius, s);
}

}  // namespace orchard::detail
