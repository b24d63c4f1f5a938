#include "level_objective.h"

#include <algorithm>
#include <cmath>

namespace orchard::detail {
namespace {

constexpr double kBeyondLimit = 1000;

}  // namespace

LevelObjective::LevelObjective(const LevelCost& by, std::span<const LevelBall> start, double bounding_radius)
    : by_(by), bounding_radius_(bounding_radius) {
  if (by_.unit > 0) return;
  by_.unit = 0;
  for (const LevelBall& ball : start) by_.unit += ball.looseness() / static_cast<double>(start.size());
  if (!(by_.unit > 0)) by_.unit = bounding_radius;
}

double LevelObjective::cost(const FittedBall& ball) const {
  const double t = std::max(0.0, ball.looseness()) / by_.unit;
  double cost = std::pow(t, by_.power);
  if (by_.cap > 0) cost *= 1 + std::pow(t / by_.cap, by_.cap_power);
  if (by_.limit > 0 && ball.looseness() > by_.limit) cost *= kBeyondLimit;
  if (by_.size_power > 0) cost *= std::pow(ball.radius / bounding_radius_, by_.size_power);
  return cost;
}

double LevelObjective::cost(std::span<const LevelBall> balls) const {
  double sum = 0;
  for (const LevelBall& ball : balls) sum += cost(ball);
  return sum;
}

std::array<double, 2> LevelObjective::sums(std::span<const LevelBall> balls) const {
  std::array<double, 2> sums{};
  for (const LevelBall& ball : balls) {
    sums[0] += ball.looseness();
    sums[1] += ball.looseness() * ball.radius * ball.radius;
  }
  return sums;
}

bool LevelObjective::keeps(std::span<const LevelBall> balls, const std::array<double, 2>& sums) const {
  if (!by_.keeps_sums) return true;
  const std::array<double, 2> own = this->sums(balls);
  return own[0] <= sums[0] && own[1] <= sums[1];
}

double LevelObjective::slope(const FittedBall& ball) const {
  FittedBall larger = ball;
  const double step = 1e-6 * by_.unit;
  larger.radius += step;
  return (cost(larger) - cost(ball)) / step;
}

}  // namespace orchard::detail
