#pragma once
#include "level_cover.h"
#include "level_trial.h"

namespace orchard::detail {

// Makes a trial's balls cover the surface that those which they replace covered: what is open goes to the ball that it
// costs least, until nothing is; then each ball is fitted to what it alone holds. False, with the trial's balls changed
// nevertheless: its cost would not stay below trial.max_cost, or something stays open. `cover` holds the same balls as
// `balls`.
bool close_trial(const Surface& surface, const LevelBalls& balls, const LevelObjective& objective,
                 const LevelCover& cover, LevelTrial& trial, BallFitter& fitter);

}  // namespace orchard::detail
