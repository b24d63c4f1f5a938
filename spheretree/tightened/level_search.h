#pragma once
#include <tbb/enumerable_thread_specific.h>

#include <cstdint>

#include "level_balls.h"
#include "level_cover.h"
#include "level_objective.h"
#include "level_trial.h"
#include "orchard/geometry/progress.h"

namespace orchard::detail {

class [[gnu::visibility("hidden")]] LevelSearch;  // hidden like BallFitter

// Large-neighbourhood search for balls with a low objective. Trials run in batches: each is made from the balls as they
// were before the batch, and they are applied in order, so the result does not depend on the number of threads.
class LevelSearch {
 public:
  LevelSearch(const Surface& surface, const LevelObjective& objective, BallMeasure measure, std::uint64_t seed,
              Index level)
      : surface_(surface), objective_(objective), seed_(seed), level_(level), scratches_([&surface, measure] {
          return TrialScratch(surface, measure);
        }) {}

  // Searches with all samples held.
  void run(LevelBalls& balls, Index trials, const Progress& progress);
  // Searches among balls that cover the surface, which they do afterwards, too: what a trial uncovers is closed before
  // the trial is judged. `cover` must hold the same balls, and does so afterwards.
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
  Index level_;                  // selects the random numbers
  std::uint64_t trials_ = 0;     // so far
  std::vector<Index> failures_;  // trials in vain that began at each ball since one last changed it
  std::vector<double> costs_;    // of the balls
  std::vector<double> wanted_;   // the argument of propose_trial()
  tbb::enumerable_thread_specific<TrialScratch> scratches_;
};

}  // namespace orchard::detail
