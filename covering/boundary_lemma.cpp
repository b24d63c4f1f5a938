#include "orchard/covering/boundary_lemma.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "circle_intervals.h"

// Why the answer "covered" is a proof
//
// Let every ball be replaced by a disk in the triangle's plane that is certainly inside the ball (project()), and let
// the path regions be the intersections of these disks along the paths. Let U be the part of the (slightly enlarged)
// triangle's interior that no closed path region holds: an open set. If U is neither empty nor everything, its border
// inside the triangle has infinitely many points, since removing finitely many points leaves a plane region connected.
// Each border point lies on the circle of some ball. By (ii), all but finitely many points of all circles inside the
// triangle lie in the interior of some path region, so a whole neighbourhood is covered, and the point is no border
// point of U. Hence U is empty or everything, and (i), a covered interior point, excludes the second. Dropping balls,
// with all that hangs on them, only shrinks the union, so whatever is doubtful is dropped.
//
// A path region that a ball itself bounds cannot hold its circle in its interior, nor can one bounded by an equal ball:
// the strict, inward-rounded test in inside_of() sees to that, so shapes with common arcs never vouch for each other.
namespace orchard {
namespace {

using detail::Arc;
using detail::CircleIntervals;
using Point2 = Eigen::Vector2d;

// Roundings that any one comparison below adds up, as a multiple of the lengths involved: each is a handful of
// operations of error 2^-53, so 2^-46 leaves a factor of ten.
constexpr double kRounding = 0x1p-46;

// Coordinates in the triangle's plane, around its first corner, so that an offset of the whole model costs no accuracy.
struct Frame {
  Point origin;
  Vector x_axis, y_axis, normal;

  explicit Frame(const std::array<Point, 3>& triangle) {
    int longest = 0;
    double best = -1;
    for (int i = 0; i < 3; ++i) {
      const double length = (corner(triangle, i + 1) - corner(triangle, i)).squaredNorm();
      if (length > best) best = length, longest = i;
    }
    origin = corner(triangle, longest);
    x_axis = unit_or(corner(triangle, longest + 1) - origin, Vector::UnitX());
    // Orthogonalised twice: a needle's third corner is almost along the first axis, and once would leave a slanted
    // frame.
    Vector across = corner(triangle, longest + 2) - origin;
    across -= across.dot(x_axis) * x_axis;
    across -= across.dot(x_axis) * x_axis;
    y_axis = unit_or(across, x_axis.unitOrthogonal());
    y_axis = (y_axis - y_axis.dot(x_axis) * x_axis).normalized();
    normal = x_axis.cross(y_axis);
  }
  Point2 flatten(const Point& p) const { return {(p - origin).dot(x_axis), (p - origin).dot(y_axis)}; }
  Point lift(const Point2& p) const { return origin + p.x() * x_axis + p.y() * y_axis; }

 private:
  static const Point& corner(const std::array<Point, 3>& triangle, int i) {
    return triangle[static_cast<std::size_t>(i % 3)];
  }
  static Vector unit_or(const Vector& v, const Vector& otherwise) {
    const double length = v.stableNorm();
    return length > 0 ? Vector(v / length) : otherwise;
  }
};

// The triangle as half-planes normal . x <= offset, and a box for the ends of needles, where the half-planes of
// neighbouring sides are nearly parallel.
struct Region {
  std::array<Point2, 3> corners;
  struct HalfPlane {
    Point2 normal;
    double angle;  // of the normal
    double offset;
  };
  std::array<HalfPlane, 5> sides;
  Point2 centroid;
  double extent = 0;  // of the coordinates
  double size = 0;    // distance of the farthest corner from the centroid

  Region(const Frame& frame, const std::array<Point, 3>& triangle) {
    for (std::size_t i = 0; i < 3; ++i) corners[i] = frame.flatten(triangle[i]);
    const double turn = (corners[1] - corners[0]).x() * (corners[2] - corners[0]).y() -
                        (corners[1] - corners[0]).y() * (corners[2] - corners[0]).x();
    if (turn < 0) std::swap(corners[1], corners[2]);
    centroid = (corners[0] + corners[1] + corners[2]) / 3;
    double low = corners[0].x(), high = low;
    for (const Point2& c : corners) {
      extent = std::max(extent, c.norm());
      size = std::max(size, (c - centroid).norm());
      low = std::min(low, c.x());
      high = std::max(high, c.x());
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Point2 along = corners[(i + 1) % 3] - corners[i];
      const double length = along.norm();
      const Point2 normal = length > 0 ? Point2(along.y() / length, -along.x() / length) : Point2(0, 1);
      // The outermost corner decides, so that rounding of the normal never cuts a corner off.
      double offset = normal.dot(corners[0]);
      for (const Point2& c : corners) offset = std::max(offset, normal.dot(c));
      sides[i] = {normal, std::atan2(normal.y(), normal.x()), offset};
    }
    sides[3] = {Point2(1, 0), 0, high};
    sides[4] = {Point2(-1, 0), detail::kTwoPi / 2, -low};
  }
};

// A disk in the plane that is certainly inside its ball. radius <= 0: dropped.
struct Disk {
  Point2 center = Point2::Zero();
  double radius = -1;
  bool holds_triangle = false;
};

class Lemma {
 public:
  Lemma(const std::array<Point, 3>& triangle, std::span<const PathBall> balls)
      : balls_(balls), frame_(triangle), region_(frame_, triangle) {}

  TriangleCover run() {
    TriangleCover result;
    if (project_balls()) {
      result.covered = true;
      return result;
    }
    result.covered = point_covered(region_.centroid);
    result.witness = frame_.lift(region_.centroid);
    for (Index ball = 0; ball < balls_.size(); ++ball) check_circle(ball, result);
    return result;
  }

 private:
  // Projects the balls and drops what is empty, doubtful, apart from the triangle or without a leaf. Returns true if
  // one path region certainly holds the whole triangle, which is convex.
  bool project_balls() {
    disks_.resize(balls_.size());
    useful_.assign(balls_.size(), 0);
    std::vector<char> path_holds(balls_.size(), 0);
    for (Index i = 0; i < balls_.size(); ++i) {
      const Index parent = balls_[i].parent;
      if (parent != kNone && disks_[parent].radius <= 0) continue;
      disks_[i] = project(balls_[i]);
      path_holds[i] = disks_[i].holds_triangle && (parent == kNone || path_holds[parent]);
      if (balls_[i].leaf && path_holds[i]) return true;
    }
    for (Index i = static_cast<Index>(balls_.size()); i-- > 0;) {
      if (disks_[i].radius > 0 && balls_[i].leaf) useful_[i] = 1;
      if (useful_[i] && balls_[i].parent != kNone) useful_[balls_[i].parent] = 1;
    }
    return false;
  }

  // The ball is shrunk by more than all roundings of the frame, of the projection and of the triangle's distance from
  // the plane through the frame's axes: whatever of the triangle is inside the disk is inside the ball.
  Disk project(const PathBall& ball) const {
    Disk disk;
    const Vector offset = ball.center - frame_.origin;
    const double slack = kRounding * (offset.norm() + ball.radius + region_.extent);
    const double radius = ball.radius - slack;
    const double height = std::abs(offset.dot(frame_.normal)) + slack;
    if (!(radius > height)) return disk;
    disk.center = {offset.dot(frame_.x_axis), offset.dot(frame_.y_axis)};
    const double in_plane = std::sqrt((radius - height) * (radius + height));
    const double fuzz = rounding(disk.center, in_plane);
    if ((disk.center - region_.centroid).norm() > in_plane + region_.size + fuzz) return disk;
    disk.radius = in_plane;
    disk.holds_triangle = std::all_of(region_.corners.begin(), region_.corners.end(), [&](const Point2& corner) {
      return (corner - disk.center).norm() <= in_plane - fuzz;
    });
    return disk;
  }

  double rounding(const Point2& center, double radius) const {
    return kRounding * (center.norm() + radius + region_.extent);
  }

  bool point_covered(const Point2& point) const {
    std::vector<char> inside(balls_.size(), 0);
    for (Index i = 0; i < balls_.size(); ++i) {
      if (!useful_[i] || (balls_[i].parent != kNone && !inside[balls_[i].parent])) continue;
      const double fuzz = rounding(disks_[i].center, disks_[i].radius);
      inside[i] = (point - disks_[i].center).norm() <= disks_[i].radius - fuzz;
      if (inside[i] && balls_[i].leaf) return true;
    }
    return false;
  }

  // What of circle `ball` lies in the triangle, rounded outward.
  void clip_to_region(const Disk& disk, CircleIntervals& needed) const {
    needed.set_all();
    for (const Region::HalfPlane& side : region_.sides) {
      const double room = side.offset + rounding(disk.center, disk.radius) - side.normal.dot(disk.center);
      if (room >= disk.radius) continue;
      if (room <= -disk.radius) return needed.clear();
      const double half = 2 * std::atan2(std::sqrt(disk.radius - room), std::sqrt(disk.radius + room));
      needed.subtract(Arc::around(side.angle, half));
      if (needed.empty()) return;
    }
  }

  // What of the circle lies in the interior of the other disk, rounded inward. With t the half angle of the arc,
  // tan^2(t/2) = (s^2 - (D - r)^2) / ((D + r)^2 - s^2); in this form a rounding moves the arc's ends by no more than
  // the circles' distance there moves, also near tangency.
  Arc inside_of(const Disk& circle, const Disk& other) const {
    const Point2 apart = other.center - circle.center;
    const double distance = apart.norm(), r = circle.radius;
    const double s = other.radius - rounding(circle.center, r) - rounding(other.center, other.radius);
    if (s <= 0) return Arc::none();
    const double above = (s - (distance - r)) * (s + (distance - r));
    const double below = (distance + r - s) * (distance + r + s);
    if (below <= 0) return Arc::all();
    if (above <= 0) return Arc::none();
    return Arc::around(std::atan2(apart.y(), apart.x()), 2 * std::atan2(std::sqrt(above), std::sqrt(below)));
  }

  // Condition (ii) for one ball: subtracts from its circle inside the triangle what path regions that avoid it cover.
  void check_circle(Index ball, TriangleCover& result) {
    const Disk& circle = disks_[ball];
    if (!useful_[ball] || circle.holds_triangle) return;
    clip_to_region(circle, needed_);
    if (needed_.empty()) return;
    covering_.resize(balls_.size());
    for (Index i = 0; i < balls_.size() && !needed_.empty(); ++i) {
      covering_[i].clear();
      if (i == ball || !useful_[i]) continue;
      const Index parent = balls_[i].parent;
      const CircleIntervals& above = parent == kNone ? needed_ : covering_[parent];
      if (above.empty()) continue;
      covering_[i].assign_intersection(above, inside_of(circle, disks_[i]));
      if (balls_[i].leaf) needed_.subtract(covering_[i]);
    }
    if (needed_.empty()) return;
    result.covered = false;
    for (const auto& interval : needed_.intervals()) {
      const auto at = [&](double angle) {
        return frame_.lift(circle.center + circle.radius * Point2(std::cos(angle), std::sin(angle)));
      };
      result.arcs.push_back({ball, at(interval.begin), at((interval.begin + interval.end) / 2), at(interval.end)});
    }
    result.witness = result.arcs.front().middle;
  }

  std::span<const PathBall> balls_;
  Frame frame_;
  Region region_;
  std::vector<Disk> disks_;
  std::vector<char> useful_;
  CircleIntervals needed_;
  std::vector<CircleIntervals> covering_;
};

}  // namespace

TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, std::span<const PathBall> balls) {
  return Lemma(triangle, balls).run();
}

double path_depth(const Point& point, std::span<const PathBall> balls) {
  std::vector<double> excess(balls.size());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    excess[i] = (point - balls[i].center).norm() - balls[i].radius;
    if (balls[i].parent != kNone) excess[i] = std::max(excess[i], excess[balls[i].parent]);
    if (balls[i].leaf) least = std::min(least, excess[i]);
  }
  return least;
}

}  // namespace orchard
