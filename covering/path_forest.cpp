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
  near.balls.clear();
  near.original.clear();
  const Point centroid = (triangle[0] + triangle[1] + triangle[2]) / 3;
  double reach = 0;
  for (const Point& corner : triangle) reach = std::max(reach, (corner - centroid).norm());
  const auto visit = [&](Index ball, Index parent) {
    const PathBall& candidate = balls_[ball];
    const double limit = (candidate.radius + reach) * (1 + 1e-9);
    if ((candidate.center - centroid).squaredNorm() > limit * limit) return;
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

// A path's excess only grows downwards: what is not below the least found so far can be left out.
void PathForest::descend(Index ball, const Point& point, double above, double& min) const {
  const double excess = std::max(above, (point - balls_[ball].center).norm() - balls_[ball].radius);
  if (excess >= min) return;
  if (balls_[ball].leaf) min = excess;
  for (Index child : children_[ball]) descend(child, point, excess, min);
}

}  // namespace orchard
