#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/redundancy.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// What the energy of a set of siblings is: the sum of the energies of its spheres, or the largest of them.
enum class SetEnergy { sum, maximum };

// What the energy of one sphere is, its distance to the solid (dissertation 5.3.2, geometry/sphere_distance.h): by
// Lemma 5.1, one query and an over-estimate; at the 20 corners of a dodecahedron, an under-estimate that may miss what
// protrudes between them; or that plus the correction that makes it an over-estimate again.
enum class SphereEnergy { lemma, samples, corrected_samples };

// The parameters of the annealing in dissertation 5.3.1.
struct AnnealingOptions {
  Index depth = 3;      // levels below the root at most
  Index branching = 8;  // children of a node at most, 2..64
  SetEnergy energy = SetEnergy::maximum;
  SphereEnergy distance = SphereEnergy::lemma;
  double move = 0.035;      // longest translation in one change, as a fraction of the parent's radius
  double min_scale = 0.95;  // smallest and largest factor on a radius in one change
  double max_scale = 1.053;
  int first_trials = 40;  // changes that are tried to find the first temperature
  // The probability with which a mean rise passes at the first temperature. The text says "high", and no number.
  double first_acceptance = 0.9;
  int max_accepted = 200, max_rejected = 200;  // changes at one temperature, whichever number is reached first
  // A change that uncovers the surface is tried again and counts as neither; but no more often than this at one
  // temperature, where every sphere of a set is held in place.
  int max_uncovering = 20'000;
  double cooling = 0.9;        // factor from one temperature to the next
  int iterations_first = 100;  // temperatures on the first level
  int iterations = 50;         // and below
  // Which spheres of a level go before the others get children. The text's implementation took independent ones.
  Selection redundancy = Selection::acyclic;
  Refinement refinement{};
  std::uint64_t seed = 1;
};

struct AnnealingReport {
  std::uint64_t changes = 0;     // tried
  std::uint64_t uncovering = 0;  // of them, undone because they break the path rule, and tried again
  std::uint64_t accepted = 0;    // of them, kept
  Index redundant = 0;           // spheres removed between levels
};

struct AnnealingBuild {
  SphereTree tree;
  AnnealingReport report;
};

// Builds a tree by simulated annealing of the children of each node, from the top down (dissertation 5.3). Children
// start as the octree's on the first level, and below as those octants of the cube around their parent (Fig. 5.8) that
// meet the surface; with another branching than 8, as that many boxes. A change moves and scales one child; one that
// breaks the path rule is undone and tried again, others pass by the Metropolis criterion. Redundant spheres are
// removed before they get children (5.3.4). The result is conservative, and the same for a seed on any number of
// threads; temperatures go through exp(), so another maths library may give another result. Throws InputError unless
// surface.solid(). Parents that no triangle meets two of are annealed in parallel.
AnnealingBuild annealed_tree(const Surface& surface, const AnnealingOptions& options = {},
                             const Progress& progress = {});

// Makes a tree of any builder tighter by annealing the children of each node, from the top down (dissertation 8.2). The
// changes are those of annealed_tree(), from the tree's own spheres in place of octants, and each set of siblings ends
// as the best one that it has been: no set gets a larger energy than it had. Take a low first_acceptance, or what the
// builder found is forgotten first. Precondition: the tree is conservative, nodes in breadth-first order; it stays so.
// `depth`, `branching`, `redundancy` and `refinement` have no meaning here. Bounds and inaccuracies become stale: call
// measure() afterwards. Throws InputError unless surface.solid(). Deterministic as above.
AnnealingReport anneal_tree(SphereTree& tree, const Surface& surface, const AnnealingOptions& options = {},
                            const Progress& progress = {});

}  // namespace orchard
