#pragma once
#include "level_solver.h"
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tightened.h"
#include "partial_tree.h"

namespace orchard::detail {

struct FinishOptions {
  int searching_rounds = 8;   // of closing uncovered regions, between which the search continues
  int tightening_rounds = 4;  // rounds after these, in which balls may still give points back
  int tightenings = 2;        // of the closed level
  Index search_trials = 0;    // trials in each of the searching rounds
  Index closed_trials = 0;    // trials afterwards, of a search that never uncovers anything
  bool keep_above = false;    // if true, the levels above do not grow
  Progress progress;          // called with a fraction of the finish
};

// Makes the solver's balls, which hold all samples but need not cover the surface between these, the last level of the
// tree, which covers the surface. Fills in the part of the report about closing.
void finish_level(const Surface& surface, LevelSolver& solver, PartialTree& partial, const FinishOptions& options,
                  TightenReport::Level& report);

}  // namespace orchard::detail
