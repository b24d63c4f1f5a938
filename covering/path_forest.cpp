#include "orchard/covering/path_forest.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace orchard {

PathForest::PathForest(std::span<const PathBall> balls) : balls_(balls.begin(), balls.end()) {
  std::vector<Index> place(balls.size() + 1, 0);
  for (Index i = 0; i < balls.size(); ++i) {
    if (balls[i].parent == kNone) {
      roots_.push_back(i);
    } else {
      ++place[balls[i].parent + 1];
    }
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  children_.offsets = place;
  children_.items.resize(place.back());
  for (Index i = 0; i < balls.size(); ++i)
    if (balls[i].parent != kNone) children_.items[place[balls[i].parent]++] = i;
}

void PathForest::gather(const std::array<Point, 3>& triangle, NearBalls& near) const {
  gather(triangle, {Point::Zero(), std::numeric_limits<double>::infinity()}, near);
}

void PathForest::gather(const std::array<Point, 3>& triangle, const Sphere& where, NearBalls& near) const {
  near.balls.clear();
  near.original.clear();
  const Point centroid = (triangle[0] + triangle[1] + triangle[2]) / 3;
  double reach = 0;
  for (const Point& corner : triangle) reach = std::max(reach, (corner - centroid).norm());
  const auto apart = [](const PathBall& ball, const Point& center, double radius) {
    const double limit = (ball.radius + radius) * (1 + 1e-9);
    return (ball.center - center).squaredNorm() > limit * limit;
  };
  const auto visit = [&](Index ball, Index parent) {
    const PathBall& candidate = balls_[ball];
    if (apart(candidate, where.center, where.radius) || apart(candidate, centroid, reach)) return;
    near.balls.push_back({candidate.center, candidate.radius, parent, candidate.leaf});
    near.original.push_back(ball);
  };
  for (Index root : roots_) visit(root, kNone);
  for (Index i = 0; i < near.balls.size(); ++i)
    for (Index child : children_[near.original[i]]) visit(child, i);
}

double PathForest::distance(const Point& point) const {
  double min = std::numeric_limits<double>::infinity();
  for (Index root : roots_) descend(root, point, -std::numeric_limits<double>::infinity(), min);
  return min;
}

// The excess of a path can only grow from the root down, so balls whose excess is not below the least leaf's so far are
// skipped.
void PathForest::descend(Index ball, const Point& point, double above, double& min) const {
  const double excess = std::max(above, (point - balls_[ball].center).norm() - balls_[ball].radius);
  if (excess >= min) return;
  if (balls_[ball].leaf) min = excess;
  for (Index child : children_[ball]) descend(child, point, excess, min);
}

bool PathForest::within(const Point& point, double limit) const {
  return std::any_of(roots_.begin(), roots_.end(), [&](Index root) { return within(root, point, limit); });
}

bool PathForest::within(Index ball, const Point& point, double limit) const {
  if ((point - balls_[ball].center).norm() - balls_[ball].radius > limit) return false;
  const std::span<const Index> below = children(ball);
  return balls_[ball].leaf || std::any_of(below.begin(), below.end(), [&](Index i) { return within(i, point, limit); });
}

bool surely_holds(const Sphere& ball, const Box& box) {
  // A wider margin than that of surely_holds() for triangles, so that a box that is held implies all its triangles are.
  constexpr double kSurelyInside = 1 - 0x1p-32;
  const double limit = ball.radius * kSurelyInside;
  const Vector farthest = (box.max() - ball.center).cwiseMax(ball.center - box.min());
  return ball.radius > 0 && farthest.squaredNorm() <= limit * limit;
}

bool HoldingPath::holds(const Box& box) {
  const auto is_around = [&](Index ball) {
    return surely_holds(Sphere{forest_.balls()[ball].center, forest_.balls()[ball].radius}, box);
  };
  Index up = last_;
  while (up != kNone && is_around(up)) up = forest_.balls()[up].parent;
  if (last_ != kNone && up == kNone) return true;
  const std::span<const Index> roots = forest_.roots();
  return std::any_of(roots.begin(), roots.end(), [&](Index root) { return descend(root, box); });
}

bool HoldingPath::descend(Index ball, const Box& box) {
  const PathBall& own = forest_.balls()[ball];
  if (!surely_holds(Sphere{own.center, own.radius}, box)) return false;
  if (own.leaf) {
    last_ = ball;
    return true;
  }
  const std::span<const Index> children = forest_.children(ball);
  return std::any_of(children.begin(), children.end(), [&](Index child) { return descend(child, box); });
}

}  // namespace orchard
