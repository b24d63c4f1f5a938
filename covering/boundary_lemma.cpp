#include "orchard/covering/boundary_lemma.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lemma_check.h"

// Why the answer "covered" is a proof
//
// Let every ball be replaced by a disk in the triangle's plane that is certainly inside the ball (project()), and let
// the path regions be the intersections of these disks along the paths. Let U be the part of the (slightly enlarged)
// region's interior that no closed path region holds: an open set. If U is neither empty nor everything, its border
// inside the region has infinitely many points, since removing finitely many points leaves a connected open set of the
// plane connected. Each border point lies on the circle of some ball. By (ii), all but finitely many points of all
// circles inside the region lie in the interior of some path region, so a whole neighbourhood is covered, and the point
// is no border point of U. Hence U is empty or everything, and (i), a covered point, excludes the second. Dropping
// balls, with all that hangs on them, only shrinks the union, so whatever is doubtful is dropped.
//
// A path region that a ball itself bounds cannot hold its circle in its interior, nor can one bounded by an equal ball:
// the strict, inward-rounded test in inside_of() sees to that, so shapes with common arcs never vouch for each other.
namespace orchard {
namespace detail {
namespace {

// a margin that is much larger than the rounding error of a distance
constexpr double kSurelyInside = 1 - 0x1p-40;
// If a triangle has at least this many balls, circles find their neighbours by a grid. Below that, testing all is
// faster.
constexpr std::size_t kManyBalls = 16;

}  // namespace

bool surely_holds(const PathBall& ball, const std::array<Point, 3>& triangle) {
  const double limit = ball.radius * kSurelyInside;
  return ball.radius > 0 && std::all_of(triangle.begin(), triangle.end(), [&](const Point& corner) {
           return (corner - ball.center).squaredNorm() <= limit * limit;
         });
}

LemmaScratch& LemmaScratch::of_this_thread() {
  thread_local LemmaScratch scratch;
  return scratch;
}

LemmaCheck::LemmaCheck(const TrianglePlane& plane, std::span<const PathBall> balls,
                       std::span<CircleInPlane* const> circles, Want want)
    : plane_(plane), balls_(balls), circles_(circles), want_(want), own_(LemmaScratch::of_this_thread()) {}

TriangleCover LemmaCheck::run() {
  TriangleCover result;
  if (plane_.empty() || find_useful(result)) {
    result.covered = true;
    return result;
  }
  own_.rests_on.assign(balls_.size(), 0);
  check_named_point(result);
  if (!result.covered && want_ == Want::answer) return result;
  if (own_.covering.size() < balls_.size()) own_.covering.resize(balls_.size());
  own_.made_for.assign(balls_.size(), kNone);
  for (Index ball = 0; ball < balls_.size(); ++ball) {
    if (check_circle(ball)) continue;
    result.covered = false;
    report_arcs(ball, result);
    if (want_ == Want::answer) break;
  }
  if (!result.covered) return result;
  for (Index ball = 0; ball < balls_.size(); ++ball)
    if (own_.rests_on[ball]) result.coverers.push_back(ball);
  return result;
}

// Drops balls that are empty, doubtful, outside the triangle or without a leaf. Returns true if a single path region
// certainly contains the whole region, which is convex.
bool LemmaCheck::find_useful(TriangleCover& result) {
  own_.useful.assign(balls_.size(), 0);
  std::vector<char>&sound = own_.sound, &holds = own_.holds;
  sound.assign(balls_.size(), 0);
  holds.assign(balls_.size(), 0);
  own_.all.clear();
  for (Index i = 0; i < balls_.size(); ++i) {
    const Index parent = balls_[i].parent;
    sound[i] = disk(i).radius > 0 && (parent == kNone || sound[parent]);
    holds[i] = sound[i] && disk(i).holds_region && (parent == kNone || holds[parent]);
    if (!balls_[i].leaf || !holds[i]) continue;
    result.coverers = {i};
    return true;
  }
  for (Index i = static_cast<Index>(balls_.size()); i-- > 0;) {
    if (sound[i] && balls_[i].leaf) own_.useful[i] = 1;
    if (own_.useful[i] && balls_[i].parent != kNone) own_.useful[balls_[i].parent] = 1;
    if (own_.useful[i]) own_.all.push_back(i);
  }
  std::reverse(own_.all.begin(), own_.all.end());
  if (own_.all.size() < kManyBalls) return false;
  own_.disks.assign(balls_.size(), {});
  for (Index i : own_.all) own_.disks[i] = disk(i);
  own_.grid.build(own_.disks, plane_.box());
  uses_grid_ = true;
  return false;
}

void LemmaCheck::check_named_point(TriangleCover& result) {
  const Point2& point = plane_.named_point();
  result.witness = plane_.lift(point);
  std::vector<char>& inside = own_.inside;
  inside.assign(balls_.size(), 0);
  for (Index i : own_.all) {
    if (balls_[i].parent != kNone && !inside[balls_[i].parent]) continue;
    inside[i] = plane_.certainly_inside(point, disk(i));
    if (!inside[i] || !balls_[i].leaf) continue;
    own_.rests_on[i] = 1;
    result.covered = true;
    return;
  }
}

// Condition (ii) for one ball.
bool LemmaCheck::check_circle(Index ball) {
  CircleInPlane& circle = *circles_[ball];
  if (!own_.useful[ball] || circle.disk.holds_region) return true;
  if (!circle.clipped) {
    plane_.clip_to_region(circle.disk, circle.needed);
    circle.clipped = true;
  }
  if (circle.needed.empty()) return true;
  own_.needed = circle.needed;
  subtract_covered(ball);
  return own_.needed.empty();
}

// Subtracts from the part of a circle that is still to be covered what the path regions that the ball does not bound
// cover.
void LemmaCheck::subtract_covered(Index ball) {
  for (Index i : candidates(ball)) {
    if (i == ball || !own_.useful[i]) continue;
    const Index parent = balls_[i].parent;
    if (parent != kNone && own_.made_for[parent] != ball) continue;
    const CircleIntervals& above = parent == kNone ? own_.needed : own_.covering[parent];
    own_.covering[i].assign_intersection(above, plane_.inside_of(disk(ball), disk(i)));
    if (own_.covering[i].empty()) continue;
    own_.made_for[i] = ball;
    if (!balls_[i].leaf) continue;
    if (own_.needed.subtract(own_.covering[i])) own_.rests_on[i] = 1;
    if (own_.needed.empty()) return;
  }
}

std::span<const Index> LemmaCheck::candidates(Index ball) {
  if (!uses_grid_) return own_.all;
  own_.grid.meeting(disk(ball), own_.near);
  return own_.near;
}

void LemmaCheck::report_arcs(Index ball, TriangleCover& result) const {
  const Disk& circle = disk(ball);
  for (const auto& interval : own_.needed.intervals()) {
    const auto at = [&](double angle) {
      return plane_.lift(circle.center + circle.radius * Point2(std::cos(angle), std::sin(angle)));
    };
    result.arcs.push_back({ball, at(interval.begin), at((interval.begin + interval.end) / 2), at(interval.end)});
  }
  result.witness = result.arcs.front().middle;
}

namespace {

TriangleCover check(const TrianglePlane& plane, std::span<const PathBall> balls, LemmaCheck::Want want) {
  LemmaScratch& own = LemmaScratch::of_this_thread();
  if (own.circles.size() < balls.size()) own.circles.resize(balls.size());
  own.pointers.resize(balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    own.circles[i].disk = plane.project(balls[i].center, balls[i].radius);
    own.circles[i].clipped = false;
    own.pointers[i] = &own.circles[i];
  }
  return LemmaCheck(plane, balls, own.pointers, want).run();
}

// Returns the first leaf with a path of balls each of which contains the triangle with a margin for all rounding
// errors; kNone if there is none. Most triangles of a fine mesh are covered in this way, and it needs no plane.
Index leaf_around(const std::array<Point, 3>& triangle, std::span<const PathBall> balls) {
  std::vector<char>& holds = LemmaScratch::of_this_thread().holds;
  holds.assign(balls.size(), 0);
  for (Index i = 0; i < balls.size(); ++i) {
    if (balls[i].parent != kNone && !holds[balls[i].parent]) continue;
    holds[i] = surely_holds(balls[i], triangle);
    if (holds[i] && balls[i].leaf) return i;
  }
  return kNone;
}

TriangleCover covered_by(Index leaf) {
  TriangleCover cover;
  cover.covered = true;
  cover.coverers = {leaf};
  return cover;
}

}  // namespace
}  // namespace detail

TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, std::span<const PathBall> balls) {
  const Index leaf = detail::leaf_around(triangle, balls);
  if (leaf != kNone) return detail::covered_by(leaf);
  return detail::check(detail::TrianglePlane(triangle), balls, detail::LemmaCheck::Want::all_arcs);
}

TriangleCover cover_of_triangle(const std::array<Point, 3>& triangle, const Sphere& clip,
                                std::span<const PathBall> balls) {
  const Index leaf = detail::leaf_around(triangle, balls);
  if (leaf != kNone) return detail::covered_by(leaf);
  return detail::check(detail::TrianglePlane(triangle, clip), balls, detail::LemmaCheck::Want::all_arcs);
}

bool triangle_covered(const std::array<Point, 3>& triangle, std::span<const PathBall> balls) {
  if (detail::leaf_around(triangle, balls) != kNone) return true;
  return detail::check(detail::TrianglePlane(triangle), balls, detail::LemmaCheck::Want::answer).covered;
}

double path_distance(const Point& point, std::span<const PathBall> balls) {
  thread_local std::vector<double> excess;
  excess.resize(std::max(excess.size(), balls.size()));
  double min = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < balls.size(); ++i) {
    excess[i] = (point - balls[i].center).norm() - balls[i].radius;
    if (balls[i].parent != kNone) excess[i] = std::max(excess[i], excess[balls[i].parent]);
    if (balls[i].leaf) min = std::min(min, excess[i]);
  }
  return min;
}

}  // namespace orchard
