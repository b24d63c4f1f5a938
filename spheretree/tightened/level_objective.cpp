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
  for (const LevelBall& ball : start) by_.unit += weighted_looseness(ball) / static_cast<double>(start.size());
  if (!(by_.unit > 0)) by_.unit = bounding_radius;
}

double LevelObjective::weighted_looseness(const FittedBall& ball) const {
  return by_.weights == nullptr ? ball.looseness() : ball.looseness() * by_.weights->at(ball.center);
}

double LevelObjective::cost(const FittedBall& ball) const {
  const double t = std::max(0.0, weighted_looseness(ball)) / by_.unit;
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

double LevelObjective::slope(const FittedBall& ball) const {
  FittedBall larger = ball;
  const double step = 1e-6 * by_.unit;
  larger.radius += step;
  return (cost(larger) - cost(ball)) / step;
}

}  // namespace orchard::detail
