#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// How the energies of siblings make the energy of the set.
enum class SetEnergy { sum, maximum };

// The numbers of dissertation 5.3.1.
struct AnnealingOptions {
  Index depth = 3;      // levels below the root at most
  Index branching = 8;  // children of a node at most, 2..64
  SetEnergy energy = SetEnergy::maximum;
  double move = 0.035;      // a translation at most, as a fraction of the parent's radius
  double min_scale = 0.95;  // of a radius in one change
  double max_scale = 1.053;
  int first_trials = 40;                       // that set the first temperature
  double first_acceptance = 0.5;               // the part of worse changes that it lets pass
  int max_accepted = 200, max_rejected = 200;  // changes at one temperature
  double cooling = 0.9;
  int iterations_first = 100;  // temperatures on the first level
  int iterations = 50;         // and below
  Refinement refinement{};
  std::uint64_t seed = 1;
};

struct AnnealingReport {
  std::uint64_t changes = 0, uncovering = 0, accepted = 0;  // tried; of them refused by the cover; of them kept
  Index redundant = 0;                                      // spheres removed between levels
};

// Dissertation 5.3: simulated annealing of the children of each node, top-down. They start as the octree's on the first
// level, and below as the octants of the cube around their parent (Fig. 5.8), those that meet the surface; with another
// branching than 8, as that many boxes. A change
// moves and scales one child; one that breaks the path rule is undone, others pass by the Metropolis criterion. A
// ball's energy is Lemma 5.1's distance, radius + signed distance of the centre. Redundant spheres go before they get
// children (5.3.4). The result is conservative.
// Parallel over those parents of a level that no triangle meets two of, one such group after the other. Temperatures go
// through exp(), so that results are the same for a seed on any number of threads, but perhaps not with another maths
// library. Throws InputError unless surface.solid().
SphereTree annealed_tree(const Surface& surface, const AnnealingOptions& options = {}, const Progress& progress = {},
                         AnnealingReport* report = nullptr);

}  // namespace orchard
