#pragma once
#include <span>

#include "level_balls.h"
#include "sets/weight_field.h"

namespace orchard::detail {

// A level's objective is the sum over its balls of t^power (1 + (t / cap)^cap_power) (radius / R)^size_power, where t
// is the looseness as a multiple of `unit`. If the power is low, the factor with `cap` keeps the loosest ball near the
// others.
struct LevelCost {
  double power = 4;
  double cap = 0, cap_power = 8;  // no cap if it is 0
  double size_power = 0;
  double limit = 0;                      // mesh units: looser balls cost a thousand times as much; none if it is 0
  double unit = 0;                       // mesh units; 0 for the mean looseness of the level's first balls
  const WeightField* weights = nullptr;  // where looseness counts more; nullptr for equal weights
};

// The objective that the search of a level minimizes. It does not change once its unit is known.
class LevelObjective {
 public:
  // If by.unit is 0, the unit is the mean looseness of `start`.
  LevelObjective(const LevelCost& by, std::span<const LevelBall> start, double bounding_radius);

  double cost(const FittedBall& ball) const;
  double cost(std::span<const LevelBall> balls) const;  // the sum of the costs
  double slope(const FittedBall& ball) const;           // the derivative of the ball's cost by its radius
  double unit() const { return by_.unit; }              // of the looseness, mesh units

 private:
  double weighted_looseness(const FittedBall& ball) const;

  LevelCost by_;
  double bounding_radius_;
};

}  // namespace orchard::detail
