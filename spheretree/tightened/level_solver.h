#pragma once
#include <vector>

#include "level_closing.h"
#include "level_cover.h"
#include "level_options.h"
#include "level_search.h"

namespace orchard::detail {

class [[gnu::visibility("hidden")]] LevelSolver;  // as BallFitter is

// The balls of one level of a tree, all at once: each lies in a path region, the common part of the balls on a path of
// the levels above, and answers for samples in it. Which path region is open, so that the load balances itself.
// The work is done by parts, each in a file of its own: path_regions and level_balls keep the samples and the balls,
// level_start seeds, level_search improves, level_tightening fits each ball to what it alone holds, and level_closing
// takes in what the samples missed.
class LevelSolver {
 public:
  // Seeds the balls, or starts from those given; paths as in PathRegions.
  LevelSolver(const Surface& surface, const Samples& samples, std::vector<std::vector<Sphere>> paths,
              const LevelOptions& options, std::vector<LevelBall> start = {});

  void search(Index trials, const Progress& progress = {});
  void tighten();  // each ball to the samples that it alone holds
  // `hold` as in level_closing.h.
  void close_regions(const std::vector<UncoveredRegion>& uncovered, bool hold);

  // From here on the balls cover the surface, and go on doing so: `cover` holds the same balls, perhaps larger.
  void take_radii(const LevelCover& cover);
  void tighten(LevelCover& cover);  // each ball to the surface that it alone covers
  void search(LevelCover& cover, Index trials);

  const std::vector<LevelBall>& balls() const { return balls_.all(); }
  double cost() const { return objective_.cost(balls_.all()); }
  double unit() const { return objective_.unit(); }  // of the looseness in the objective

 private:
  const Surface& surface_;
  LevelBalls balls_;
  LevelObjective objective_;
  LevelSearch search_;
};

}  // namespace orchard::detail
