#include "level_cover.h"

#include <algorithm>
#include <limits>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

// Distances may be off by a few rounding errors, so comparisons have this margin.
constexpr double kReachFactor = 1 + 1e-9;

bool apart(const Sphere& ball, const Point& center, double reach) {
  const double limit = (ball.radius + reach) * kReachFactor;
  return (ball.center - center).squaredNorm() > limit * limit;
}

bool within(const Sphere& where, const Point& point) { return (point - where.center).norm() <= where.radius; }

// Without the ball, most triangles that only one ball of a level covers have no leaf near them. Then the whole triangle
// is open, and no circle bounds the open part. Returns true in that case and appends the triangle's corners in the
// sphere. If no corner is in the sphere, it returns false, because the triangle may or may not reach into it.
bool wholly_open(const std::array<Point, 3>& corners, const Sphere& where, std::span<const PathBall> near,
                 std::vector<OpenArc>& arcs) {
  if (std::any_of(near.begin(), near.end(), [](const PathBall& ball) { return ball.leaf; })) return false;
  const std::size_t before = arcs.size();
  for (const Point& corner : corners)
    if (within(where, corner)) arcs.push_back({corner, corner});
  return arcs.size() > before;
}

}  // namespace

LevelCover::LevelCover(const Surface& surface, std::span<const PathBall> upper, std::vector<Index> path_ends,
                       std::vector<PlacedBall> balls)
    : surface_(surface),
      margin_(tolerance::kCoverMargin * surface.bounding_radius()),
      upper_(upper),
      path_ends_(std::move(path_ends)),
      region_at_(upper.size(), kNone),
      balls_(std::move(balls)),
      balls_in_(path_ends_.size()) {
  for (Index r = 0; r < path_ends_.size(); ++r)
    if (path_ends_[r] != kNone) region_at_[path_ends_[r]] = r;
  for (Index b = 0; b < balls_.size(); ++b) balls_in_[balls_[b].path_region].push_back(b);
}

void LevelCover::replace(Index ball, const PlacedBall& by) {
  if (by.path_region != balls_[ball].path_region) {
    std::erase(balls_in_[balls_[ball].path_region], ball);
    balls_in_[by.path_region].push_back(ball);
  }
  balls_[ball] = by;
}

bool LevelCover::in_path_region(Index path_region, const Point& point) const {
  if (path_ends_[path_region] == kNone) return false;
  for (Index node = path_ends_[path_region]; node != kNone; node = upper_.balls()[node].parent) {
    const PathBall& ball = upper_.balls()[node];
    if ((point - ball.center).norm() > ball.radius - margin_) return false;
  }
  return true;
}

// Collects the balls near the part of the triangle in the sphere, parents first.
void LevelCover::gather(const std::array<Point, 3>& corners, const Sphere& where, const Change& change,
                        NearBalls& near) const {
  upper_.gather(corners, where, near);
  const Point middle = (corners[0] + corners[1] + corners[2]) / 3;
  double reach = 0;
  for (const Point& corner : corners) reach = std::max(reach, (corner - middle).norm());
  const auto visit = [&](const Sphere& ball, Index parent) {
    if (apart(ball, where.center, where.radius) || apart(ball, middle, reach)) return;
    near.balls.push_back({ball.center, ball.radius, parent, true});
  };
  for (Index i = 0, count = static_cast<Index>(near.balls.size()); i < count; ++i) {
    const Index path_region = region_at_[near.original[i]];
    if (path_region == kNone) continue;
    for (Index b : balls_in_[path_region])
      if (std::find(change.gone.begin(), change.gone.end(), b) == change.gone.end()) visit(balls_[b].sphere, i);
    for (const PlacedBall& ball : change.added)
      if (ball.path_region == path_region) visit(ball.sphere, i);
  }
}

// Returns the balls that meet it, in path regions that may meet it.
std::vector<Index> LevelCover::others_near(Index ball) const {
  std::vector<Index> others;
  find_others_near(ball, upper_.roots(), others);
  return others;
}

// Finds those below some balls of the tree above.
void LevelCover::find_others_near(Index ball, std::span<const Index> upper, std::vector<Index>& others) const {
  const Sphere& sphere = balls_[ball].sphere;
  for (Index node : upper) {
    const PathBall& above = upper_.balls()[node];
    if (apart({above.center, above.radius}, sphere.center, sphere.radius)) continue;
    find_others_near(ball, upper_.children(node), others);
    const Index path_region = region_at_[node];
    if (path_region == kNone) continue;
    for (Index b : balls_in_[path_region])
      if (b != ball && !apart(balls_[b].sphere, sphere.center, sphere.radius)) others.push_back(b);
  }
}

bool LevelCover::path_holds(Index path_region, const Box& box) const {
  for (Index node = path_ends_[path_region]; node != kNone; node = upper_.balls()[node].parent)
    if (!surely_holds(Sphere{upper_.balls()[node].center, upper_.balls()[node].radius}, box)) return false;
  return true;
}

void LevelCover::triangles_near(Index ball, std::vector<Index>& triangles) const {
  std::vector<Index> others = others_near(ball);
  const auto is_held = [&](const Box& box) {
    for (std::size_t i = 0; i < others.size(); ++i) {
      const PlacedBall& other = balls_[others[i]];
      if (!surely_holds(other.sphere, box) || !path_holds(other.path_region, box)) continue;
      std::swap(others[0], others[i]);  // adjacent boxes follow each other
      return true;
    }
    return false;
  };
  surface_.triangles_near(balls_[ball].sphere, is_held, triangles);
}

void LevelCover::triangles_resting_on(std::span<const Index> balls, Scratch& scratch,
                                      std::vector<Index>& triangles) const {
  triangles.clear();
  for (Index b : balls) {
    surface_.triangles_near(balls_[b].sphere, scratch.triangles);
    triangles.insert(triangles.end(), scratch.triangles.begin(), scratch.triangles.end());
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  const Sphere everywhere{Point::Zero(), std::numeric_limits<double>::infinity()};
  std::erase_if(triangles, [&](Index triangle) {
    const auto corners = surface_.corners(triangle);
    gather(corners, everywhere, {balls, {}}, scratch.near);
    return triangle_covered(corners, scratch.near.balls);
  });
}

void LevelCover::open_arcs(std::span<const Index> triangles, const Sphere& where, const Change& change,
                           Scratch& scratch, std::vector<OpenArc>& arcs) const {
  scratch.open.clear();
  for (Index triangle : triangles) {
    const auto corners = surface_.corners(triangle);
    gather(corners, where, change, scratch.near);
    if (wholly_open(corners, where, scratch.near.balls, arcs)) {
      scratch.open.push_back(triangle);
      continue;
    }
    const TriangleCover cover = cover_of_triangle(corners, where, scratch.near.balls);
    if (cover.covered) continue;
    scratch.open.push_back(triangle);
    const std::size_t before = arcs.size();
    for (const UncoveredArc& arc : cover.arcs) arcs.push_back({arc.begin, arc.end});
    for (const Point& corner : corners) {
      if (!within(where, corner)) continue;
      if (path_distance(corner, scratch.near.balls) > -margin_) arcs.push_back({corner, corner});
    }
    if (arcs.size() == before) arcs.push_back({cover.witness, cover.witness});
  }
}

bool LevelCover::covered(std::span<const Index> triangles, const Sphere& where, const Change& change,
                         Scratch& scratch) const {
  return std::all_of(triangles.begin(), triangles.end(), [&](Index triangle) {
    const auto corners = surface_.corners(triangle);
    gather(corners, where, change, scratch.near);
    return cover_of_triangle(corners, where, scratch.near.balls).covered;
  });
}

}  // namespace orchard::detail
