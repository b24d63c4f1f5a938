#pragma once
#include "level_solver.h"
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/tightened.h"
#include "partial_tree.h"

namespace orchard::detail {

struct ClosingOptions {
  int polishing = 8;        // rounds that search again among the samples, with what was found open
  Index search_trials = 0;  // in each of them
  Index closed_trials = 0;  // afterwards, of the search that never uncovers anything
  Progress progress;        // called with a fraction of the closing
};

// Turns the solver's balls, which hold its samples, into the stack's last level, which covers the surface. Fills in
// what the report says about closing.
void close_level(const Surface& surface, LevelSolver& solver, PartialTree& stack, const ClosingOptions& options,
                 TightenReport::Level& report);

}  // namespace orchard::detail
