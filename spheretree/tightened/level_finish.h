#pragma once
#include "level_solver.h"
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tightened.h"
#include "partial_tree.h"

namespace orchard::detail {

struct FinishOptions {
  int searching_rounds = 8;   // of taking in what is open: the search among the samples goes on in these
  int tightening_rounds = 4;  // those after them, in which balls may still let go of what they took in
  int tightenings = 2;        // of the closed level
  Index search_trials = 0;    // in each of the searching rounds
  Index closed_trials = 0;    // afterwards, of the search that never uncovers anything
  bool keep_above = false;    // whether the levels above are not to grow
  Progress progress;          // called with a fraction of the finish
};

// Turns the solver's balls, which hold its samples, into the last level of the tree, which covers the surface. Fills in
// what the report says about closing.
void finish_level(const Surface& surface, LevelSolver& solver, PartialTree& partial, const FinishOptions& options,
                  TightenReport::Level& report);

}  // namespace orchard::detail
