#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <cstdint>

#include "level_balls.h"
#include "level_cover.h"
#include "level_objective.h"
#include "level_trial.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

class [[gnu::visibility("hidden")]] LevelSearch;  // as BallFitter is

// Large-neighbourhood search for balls with a low objective. Trials run in batches, each on the balls as they were
// before the batch, and are applied in order, so the result does not depend on threads.
class LevelSearch {
 public:
  LevelSearch(const Surface& surface, const LevelObjective& objective, BallMeasure measure, std::uint64_t seed,
              Index level)
      : surface_(surface), objective_(objective), seed_(seed), level_(level), scratches_([&surface, measure] {
          return TrialScratch(surface, measure);
        }) {}

  // No sample is lost.
  void run(LevelBalls& balls, Index trials, const Progress& progress);
  // The balls cover the surface, and go on doing so: what a trial leaves open is closed before it is judged. `cover`
  // holds the same balls, before and after.
  void run_covering(LevelBalls& balls, Index trials, LevelCover& cover);

 private:
  void run(LevelBalls& balls, Index trials, LevelCover* cover, const Progress& progress);
  void find_costs(const LevelBalls& balls);
  void want();
  LevelTrial propose(const LevelBalls& balls, std::uint64_t number, const LevelCover* cover);
  void apply(std::vector<LevelTrial>& batch, LevelBalls& balls, LevelCover* cover);

  const Surface& surface_;
  LevelObjective objective_;
  std::uint64_t seed_;
  Index level_;                  // for the random numbers
  std::uint64_t trials_ = 0;     // so far
  std::vector<Index> failures_;  // trials that began at each ball since it was last changed by one
  std::vector<double> costs_;    // of the balls
  std::vector<double> wanted_;   // as propose_trial() takes it
  tbb::enumerable_thread_specific<TrialScratch> scratches_;
};

}  // namespace orchard::detail
