#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "level_solver.h"

// How LevelSolver takes in what its samples missed.
namespace orchard::detail {
namespace {

constexpr int kEvaluations = 14;
// Between a region's corner and its deepest point: corners themselves lie on other balls, and would be let go again.
constexpr double kInward = 0.1;
// What breaks ties between balls that would not get looser at all, as a fraction of growth.
constexpr double kTie = 1e-9;
// A region is taken in whole unless that costs so many times what its deepest point does.
constexpr double kDearer = 8;

}  // namespace

// The objective is convex in the looseness: a rise is at least the slope times the growth, which spares most balls.
std::vector<double> LevelSolver::slopes() const {
  std::vector<double> slopes;
  for (const LevelBall& ball : balls_) {
    FittedBall larger = ball;
    const double step = 1e-6 * options_.cost.unit;
    larger.radius += step;
    slopes.push_back((cost(larger) - cost(ball)) / step);
  }
  return slopes;
}

LevelSolver::Taker LevelSolver::cheapest_taker(std::span<const Point> region, const std::vector<double>& slopes) const {
  Taker best{kNone, std::numeric_limits<double>::infinity()};
  for (Index b = 0; b < balls_.size(); ++b) {
    const LevelBall& ball = balls_[b];
    FittedBall grown = ball;
    for (const Point& p : region) grown.radius = std::max(grown.radius, (p - ball.center).norm());
    const double growth = grown.radius - ball.radius;
    if (slopes[b] * growth > best.rise * (1 + 1e-3)) continue;
    if (!std::all_of(region.begin(), region.end(), [&](const Point& p) { return in_path(ball.region, p); })) continue;
    const double rise = (growth > 0 ? cost(grown) - cost(ball) : 0) + kTie * growth / surface_.bounding_radius();
    if (rise < best.rise) best = {b, rise};
  }
  return best;
}

void LevelSolver::add_sample(const Point& point, const Point& start) {
  const Index sample = samples_.size();
  samples_.points.push_back(point);
  samples_.starts.push_back(start);
  regions_of_.emplace_back();
  holders_.push_back(0);
  for (Index r = 0; r < paths_.size(); ++r) {
    if (!in_path(r, point)) continue;
    regions_of_[sample].push_back(r);
    regions_[r].push_back(sample);
  }
}

void LevelSolver::take_in(const std::vector<UncoveredRegion>& regions, bool hold) {
  const std::size_t count = regions.size();
  const std::vector<double> slopes = this->slopes();
  std::vector<Taker> whole(count), deepest_only(count);
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    std::vector<Point> points = regions[i].corners;
    points.push_back(regions[i].deepest);
    whole[i] = cheapest_taker(points, slopes);
    deepest_only[i] = cheapest_taker({&regions[i].deepest, 1}, slopes);
  });
  std::vector<std::vector<Point>> extra(balls_.size());
  const Index old = samples_.size();
  for (std::size_t i = 0; i < count; ++i) {
    const UncoveredRegion& region = regions[i];
    const bool together = whole[i].rise <= kDearer * deepest_only[i].rise;
    const Index taker = together ? whole[i].ball : deepest_only[i].ball;
    if (taker == kNone) continue;  // for the levels above to mend
    // A long sliver, or one across the border of a region, falls apart.
    if (together) extra[taker].insert(extra[taker].end(), region.corners.begin(), region.corners.end());
    extra[taker].push_back(region.deepest);
    add_sample(region.deepest, balls_[taker].center);
    if (!hold || !together) continue;
    for (const Point& p : region.corners)
      add_sample((1 - kInward) * p + kInward * region.deepest, balls_[taker].center);
  }
  for (LevelBall& ball : balls_) {
    find_members(ball);
    for (auto s = std::lower_bound(ball.samples.begin(), ball.samples.end(), old); s != ball.samples.end(); ++s)
      ++holders_[*s];
  }
  BallFitter fitter(surface_);
  for (Index b = 0; b < balls_.size(); ++b) {
    if (extra[b].empty()) continue;
    for (Index s : balls_[b].samples)
      if (holders_[s] == 1) extra[b].push_back(samples_.points[s]);
    replace(b, fitter.fit(extra[b], balls_[b].center, kEvaluations));
  }
}

}  // namespace orchard::detail
