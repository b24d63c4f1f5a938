#pragma once
#include <span>
#include <vector>

#include "level_balls.h"
#include "level_objective.h"
#include "orchard/geometry/random.h"

namespace orchard::detail {

// One step of the large-neighbourhood search: some balls, and their replacements.
struct LevelTrial {
  std::vector<Index> chosen;              // balls of the level
  std::vector<LevelBall> balls;           // their replacements, as many; empty if nothing better was found
  std::vector<std::vector<Point>> needs;  // the points that each replacement must contain
  Index moved = kNone;  // the ball that moves elsewhere, an index into `chosen`; those after it are near its new place
  double max_cost = 0;  // the cost of the replacements must be below this
};

struct [[gnu::visibility("hidden")]] TrialScratch;  // like BallFitter

// The memory of trials, which is reused from one trial to the next; one per thread.
struct TrialScratch {
  TrialScratch(const Surface& surface, BallMeasure measure) : fitter(surface, measure) {}
  BallFitter fitter;
  std::vector<float> x, y, z;     // the samples that the chosen balls gave up
  std::vector<float> min, owner;  // for each sample, the smallest looseness that a ball gets by it, and this ball
};

// Proposes a trial. A few neighbouring balls give up the samples that only they contain, some of them move elsewhere,
// and the samples are divided among them again. The trial has replacements if the objective falls and every sample is
// contained; the lists of samples of the replacements are not filled. `wanted` has the cumulative weights with which
// each ball is chosen as the first one of a trial. The trial depends only on the state of `random`.
LevelTrial propose_trial(const LevelBalls& balls, const LevelObjective& objective, std::span<const double> wanted,
                         Random random, TrialScratch& scratch);

}  // namespace orchard::detail
