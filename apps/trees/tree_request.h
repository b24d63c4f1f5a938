#pragma once
#include <functional>
#include <vector>

#include "orchard/spheretree/build.h"

namespace orchard::apps {

// What a command line says of a tree: the options of every builder, side by side, of which the chosen one takes its
// own. The members are described where the library takes them, in the options of the builders.
struct TreeRequest {
  TreeMethod method = TreeMethod::tightened;
  Index depth = 3, branching = 8;
  std::vector<Index> spheres;  // in place of depth and branching
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;
  MergeClosing closing = MergeClosing::refit;
  SetEnergy energy = SetEnergy::maximum;
  SphereEnergy distance = SphereEnergy::lemma;
  // The numbers of the annealing that were given, in place of those of the effort.
  std::vector<std::function<void(AnnealingOptions&)>> schedule;
  Selection redundancy = Selection::exhaustive;
  bool anneal = false;       // after any other method
  Index descent_trials = 0;  // for each node, after any method; 0: no descent
  Refinement refinement;
};

// The number of levels below the root.
Index levels_of(const TreeRequest& request);

// The options of the chosen builder.
TreeOptions builder_of(const TreeRequest& request, std::uint64_t seed = 1);

// The options of all stages of the tree. Those of the points and of the axis remain the standard ones.
SphereTreeOptions tree_options(const TreeRequest& request, std::uint64_t seed);

}  // namespace orchard::apps
