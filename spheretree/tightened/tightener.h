#pragma once
#include <optional>
#include <vector>

#include "level_samples.h"
#include "level_solver.h"
#include "orchard/spheretree/tightened.h"
#include "partial_tree.h"

namespace orchard::detail {

// How much work the levels get; of everything, the best of some is kept.
struct Work {
  double trials;         // of the neighbourhood search, as a multiple of the standard number
  int searching_rounds;  // of closing a level: those in which the search goes on
  double closed_trials;  // for each ball of a level, of the search in closed levels
  Index explored;        // starts of the first level that are tried on a few samples, if it has few balls
  Index starts[2];       // of the first level, if it has few balls, and of the second, that are carried through
};

// Builds a tree level by level, each on the balls of the one above.
class Tightener {
 public:
  // Keeps references to all but the root. Samples as surface_samples() gives them.
  Tightener(const Surface& surface, const Samples& samples, const Sphere& root, const TightenOptions& options,
            const Work& work, const Progress& progress);
  TightenBuild run();

 private:
  struct Candidate {
    PartialTree partial;
    double looseness;                      // what candidates are compared by
    std::vector<double> center_distances;  // signed distances of the last level's centres
    TightenReport::Level report;
  };
  bool build_level(Index level, std::vector<TightenReport::Level>& reports);
  void take(Candidate best);
  std::vector<std::vector<LevelBall>> promising_starts(LevelOptions options, Index wanted) const;
  std::vector<Candidate> candidates(LevelOptions options, std::vector<std::vector<LevelBall>> from,
                                    const Progress& progress);
  void search_and_finish(LevelSolver& solver, const LevelOptions& options, const Progress& progress,
                         Candidate& result) const;

  const Surface& surface_;
  const Samples& samples_;
  const TightenOptions& options_;
  const Work work_;
  const Progress& progress_;
  PartialTree partial_;
};

}  // namespace orchard::detail
