#include "level_closing.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "takers.h"

namespace orchard::detail {
namespace {

// Between an uncovered region's corner and its farthest point: corners themselves lie on other balls, and would be let
// go again.
constexpr double kInward = 0.1;

// Finds the ball that given points cost least. The objective is convex in the looseness: a rise is at least the slope
// times the growth, which spares most balls.
class TakerSearch {
 public:
  TakerSearch(const LevelBalls& balls, const LevelObjective& objective, double bounding_radius)
      : balls_(balls), objective_(objective), bounding_radius_(bounding_radius) {
    for (auto* numbers : {&x_, &y_, &z_, &radii_, &slopes_}) numbers->resize(balls.size());
    for (Index b = 0; b < balls.size(); ++b) {
      const LevelBall& ball = balls[b];
      x_[b] = ball.center.x(), y_[b] = ball.center.y(), z_[b] = ball.center.z();
      radii_[b] = ball.radius;
      slopes_[b] = objective.slope(ball);
    }
  }

  // Of the balls in whose path region all the points lie; the first, if there are several. The last point, which is
  // an uncovered region's farthest, says which to begin at.
  Taker cheapest(std::span<const Point> points) const {
    if (balls_.size() == 0) return {};
    const Point& p = points.back();
    const auto dx = x_ - p.x(), dy = y_ - p.y(), dz = z_ - p.z();
    const Eigen::ArrayXd min_rises = slopes_ * ((dx * dx + (dy * dy + dz * dz)).sqrt() - radii_);
    Eigen::Index first = 0;
    min_rises.minCoeff(&first);
    Taker best;
    consider(static_cast<Index>(first), points, best);
    for (Index b = 0; b < balls_.size(); ++b)
      if (b != first && !surely_above(min_rises[b], best)) consider(b, points, best);
    return best;
  }

 private:
  static bool surely_above(double min_rise, const Taker& best) { return min_rise > best.rise * (1 + 1e-3); }

  void consider(Index b, std::span<const Point> points, Taker& best) const {
    const LevelBall& ball = balls_[b];
    FittedBall grown = ball;
    const auto too_dear = [&](const Point& p) {
      grown.radius = std::max(grown.radius, (p - ball.center).norm());
      return surely_above(slopes_[b] * (grown.radius - ball.radius), best);
    };
    if (std::any_of(points.begin(), points.end(), too_dear)) return;
    const double growth = grown.radius - ball.radius;
    if (!std::all_of(points.begin(), points.end(),
                     [&](const Point& p) { return balls_.regions().holds(ball.path_region, p); }))
      return;
    const double rise =
        (growth > 0 ? objective_.cost(grown) - objective_.cost(ball) : 0) + kTakerTie * growth / bounding_radius_;
    if (rise < best.rise || (rise == best.rise && b < best.ball)) best = {b, rise};
  }

  const LevelBalls& balls_;
  const LevelObjective& objective_;
  double bounding_radius_;
  Eigen::ArrayXd x_, y_, z_, radii_;  // of the balls
  Eigen::ArrayXd slopes_;             // of each ball's cost, by its radius
};

// Each ball to what it has taken in and to the samples that it alone holds. Balls that are apart share no sample.
void fit_again(const Surface& surface, std::vector<std::vector<Point>>& taken, LevelBalls& balls) {
  std::vector<Index> order;
  for (Index b = 0; b < balls.size(); ++b)
    if (!taken[b].empty()) order.push_back(b);
  while (!order.empty()) {
    const std::vector<Index> batch = balls.take_apart(order);
    std::vector<FittedBall> fitted(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      std::vector<Point>& points = taken[batch[i]];
      balls.append_held_alone(batch[i], points);
      fitted[i] = BallFitter(surface).fit(points, balls[batch[i]], kTakerEvaluations);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) balls.replace(batch[i], fitted[i]);
  }
}

}  // namespace

void take_in(const Surface& surface, const LevelObjective& objective, const std::vector<UncoveredRegion>& uncovered,
             bool hold, LevelBalls& balls) {
  const TakerSearch search(balls, objective, surface.bounding_radius());
  const std::vector<Taking> takings =
      find_takers(uncovered, [&](std::span<const Point> points) { return search.cheapest(points); });
  std::vector<std::vector<Point>> taken(balls.size());
  Samples fresh;
  const auto add_sample = [&](const Point& point, Index ball) {
    fresh.points.push_back(point);
    fresh.starts.push_back(balls[ball].center);
  };
  for (std::size_t i = 0; i < uncovered.size(); ++i) {
    const UncoveredRegion& region = uncovered[i];
    const auto [taker, whole] = takings[i];
    if (taker == kNone) continue;
    if (whole) taken[taker].insert(taken[taker].end(), region.corners.begin(), region.corners.end());
    taken[taker].push_back(region.farthest);
    add_sample(region.farthest, taker);
    if (!hold || !whole) continue;
    for (const Point& p : region.corners) add_sample((1 - kInward) * p + kInward * region.farthest, taker);
  }
  balls.add_samples(fresh);
  fit_again(surface, taken, balls);
}

}  // namespace orchard::detail
