#include "level_closing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace orchard::detail {
namespace {

constexpr int kEvaluations = 14;
// Between an uncovered region's corner and its deepest point: corners themselves lie on other balls, and would be let
// go again.
constexpr double kInward = 0.1;
// What breaks ties between balls that would not get looser at all, as a fraction of growth.
constexpr double kTie = 1e-9;

struct Taker {
  Index ball = kNone;
  double rise = std::numeric_limits<double>::infinity();  // of its cost
};

// Finds the ball that given points cost least. The objective is convex in the looseness: a rise is at least the slope
// times the growth, which spares most balls.
class TakerSearch {
 public:
  TakerSearch(const LevelBalls& balls, const LevelObjective& objective, double bounding_radius)
      : balls_(balls), objective_(objective), bounding_radius_(bounding_radius) {
    for (const LevelBall& ball : balls.all()) slopes_.push_back(objective.slope(ball));
  }

  // Of the balls in whose path region all the points lie.
  Taker cheapest(std::span<const Point> points) const {
    Taker best;
    for (Index b = 0; b < balls_.size(); ++b) {
      const LevelBall& ball = balls_[b];
      FittedBall grown = ball;
      for (const Point& p : points) grown.radius = std::max(grown.radius, (p - ball.center).norm());
      const double growth = grown.radius - ball.radius;
      if (slopes_[b] * growth > best.rise * (1 + 1e-3)) continue;
      if (!std::all_of(points.begin(), points.end(),
                       [&](const Point& p) { return balls_.regions().holds(ball.path_region, p); }))
        continue;
      const double rise =
          (growth > 0 ? objective_.cost(grown) - objective_.cost(ball) : 0) + kTie * growth / bounding_radius_;
      if (rise < best.rise) best = {b, rise};
    }
    return best;
  }

 private:
  const LevelBalls& balls_;
  const LevelObjective& objective_;
  double bounding_radius_;
  std::vector<double> slopes_;  // of each ball's cost, by its radius
};

}  // namespace

void take_in(const Surface& surface, const LevelObjective& objective, const std::vector<UncoveredRegion>& uncovered,
             bool hold, LevelBalls& balls) {
  const TakerSearch search(balls, objective, surface.bounding_radius());
  std::vector<Taker> whole(uncovered.size()), deepest_only(uncovered.size());
  tbb::parallel_for(std::size_t{0}, uncovered.size(), [&](std::size_t i) {
    whole[i] = search.cheapest(uncovered[i].points());
    deepest_only[i] = search.cheapest({&uncovered[i].deepest, 1});
  });
  std::vector<std::vector<Point>> taken(balls.size());
  Samples fresh;
  const auto add_sample = [&](const Point& point, Index ball) {
    fresh.points.push_back(point);
    fresh.starts.push_back(balls[ball].center);
  };
  for (std::size_t i = 0; i < uncovered.size(); ++i) {
    const UncoveredRegion& region = uncovered[i];
    const bool together = taken_whole(whole[i].rise, deepest_only[i].rise);
    const Index taker = together ? whole[i].ball : deepest_only[i].ball;
    if (taker == kNone) continue;
    // Otherwise it is a long sliver, or lies across the border of a path region, and will fall apart.
    if (together) taken[taker].insert(taken[taker].end(), region.corners.begin(), region.corners.end());
    taken[taker].push_back(region.deepest);
    add_sample(region.deepest, taker);
    if (!hold || !together) continue;
    for (const Point& p : region.corners) add_sample((1 - kInward) * p + kInward * region.deepest, taker);
  }
  balls.add_samples(fresh);
  BallFitter fitter(surface);
  for (Index b = 0; b < balls.size(); ++b) {
    if (taken[b].empty()) continue;
    balls.append_held_alone(b, taken[b]);
    balls.replace(b, fitter.fit(taken[b], balls[b].center, kEvaluations));
  }
}

}  // namespace orchard::detail
