#pragma once
#include "level_solver.h"

namespace orchard::detail {

// One step of the large-neighbourhood search.
struct LevelSolver::Trial {
  std::vector<Index> chosen;
  std::vector<LevelBall> balls;           // in their place; empty: nothing better
  std::vector<std::vector<Point>> needs;  // what each of them must hold
  Index moved = kNone;                    // into `chosen`: the one that leaves its place, with those after it near that
};

}  // namespace orchard::detail
