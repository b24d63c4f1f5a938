#pragma once
#include <vector>

#include "level_closing.h"
#include "level_cover.h"
#include "level_options.h"
#include "level_search.h"

namespace orchard::detail {

class [[gnu::visibility("hidden")]] LevelSolver;  // hidden as BallFitter is

// Solves the balls of one level of a tree all at once. Each lies in a path region, the common part of the balls on a
// path of the levels above, and covers samples in it. The path region of a ball is not fixed, so that the load balances
// itself. The work is divided into files: path_regions and level_balls keep the samples and the balls, level_start
// places the first balls, level_search improves them, level_tightening fits each ball to the samples that only it
// contains, and level_closing covers what the samples missed.
class LevelSolver {
 public:
  // Places the first balls, or starts from the given ones. The paths are those of PathRegions.
  LevelSolver(const Surface& surface, const Samples& samples, std::vector<std::vector<Sphere>> paths,
              const LevelOptions& options, std::vector<LevelBall> start = {});

  void search(Index trials, const Progress& progress = {});
  void tighten();  // fits each ball to the samples that only it contains
  // `hold` is the parameter of level_closing.h.
  void close_regions(const std::vector<UncoveredRegion>& uncovered, bool hold);

  // From now on, the balls cover the surface and keep covering it. `cover` contains the same balls, possibly larger.
  void take_radii(const LevelCover& cover);
  void tighten(LevelCover& cover);  // fits each ball to the part of the surface that only it covers
  void search(LevelCover& cover, Index trials);

  const std::vector<LevelBall>& balls() const { return balls_.all(); }
  double cost() const { return objective_.cost(balls_.all()); }
  double unit() const { return objective_.unit(); }  // the unit of looseness in the objective

 private:
  const Surface& surface_;
  LevelBalls balls_;
  LevelObjective objective_;
  LevelSearch search_;
};

}  // namespace orchard::detail
