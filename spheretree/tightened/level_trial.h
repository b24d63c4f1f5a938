#pragma once
#include <span>
#include <vector>

#include "level_balls.h"
#include "level_objective.h"
#include "orchard/geometry/random.h"

namespace orchard::detail {

// One step of the large-neighbourhood search: some balls, and what to put in their place.
struct LevelTrial {
  std::vector<Index> chosen;              // balls of the level
  std::vector<LevelBall> balls;           // in their place, as many; empty: nothing better was found
  std::vector<std::vector<Point>> needs;  // what each of these must hold
  Index moved = kNone;  // into `chosen`: the one that leaves its place; those after it lie near that place
  double max_cost = 0;  // that the new balls must stay below for the trial to be worthwhile
};

struct [[gnu::visibility("hidden")]] TrialScratch;  // as BallFitter is

// What trials are worked out in, kept from one to the next for the room that its lists have: one per thread.
struct TrialScratch {
  TrialScratch(const Surface& surface, BallMeasure measure) : fitter(surface, measure) {}
  BallFitter fitter;
  std::vector<float> x, y, z;     // of the samples that were given up
  std::vector<float> min, owner;  // how loose the trial's balls get by each at least, and which does
};

// A few neighbouring balls give up what only they hold, some start over, and they share it out again. The trial has
// balls if the objective falls and every sample is held; their samples are not found yet. `wanted`: how much each ball
// is wanted as the one that a trial begins at, summed up over the balls. Only `random` decides which trial it is.
LevelTrial propose_trial(const LevelBalls& balls, const LevelObjective& objective, std::span<const double> wanted,
                         Random random, TrialScratch& scratch);

}  // namespace orchard::detail
