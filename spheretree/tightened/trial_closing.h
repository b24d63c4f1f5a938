#pragma once
#include "level_cover.h"
#include "level_trial.h"

namespace orchard::detail {

// Makes a trial's balls cover the part of the surface that the balls which they replace covered. Each open place goes
// to the ball for which it costs least, until nothing is open; then each ball is fitted to what only it contains.
// Returns false if the cost would not stay below trial.max_cost or if something stays open; the trial's balls are
// changed in that case, too. `cover` contains the same balls as `balls`.
bool close_trial(const Surface& surface, const LevelBalls& balls, const LevelObjective& objective,
                 const LevelCover& cover, LevelTrial& trial, BallFitter& fitter);

}  // namespace orchard::detail
