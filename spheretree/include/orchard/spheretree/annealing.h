#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/spheretree/effort.h"
#include "orchard/spheretree/redundancy.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

// Builds sphere-trees by simulated annealing, as in chapter 5.3 of the dissertation.
namespace orchard {

// The energy of a set of siblings: the sum of the energies of its spheres, or the largest of them.
enum class SetEnergy { sum, maximum };

// The energy of one sphere, which is an estimate of its distance to the solid (dissertation 5.3.2,
// geometry/sphere_distance.h).
//   lemma             Lemma 5.1: an over-estimate from one query.
//   samples           The largest distance at the 20 corners of a dodecahedron: an under-estimate, which misses what
//                     protrudes between the corners.
//   corrected_samples The same plus the correction that makes it an over-estimate.
enum class SphereEnergy { lemma, samples, corrected_samples };

// The parameters of the annealing in dissertation 5.3.1.
struct AnnealingOptions {
  Index depth = 3;      // The maximum number of levels below the root.
  Index branching = 8;  // The maximum number of children of a node, 2..64.
  SetEnergy energy = SetEnergy::maximum;
  SphereEnergy distance = SphereEnergy::lemma;
  double move = 0.035;      // The longest translation in one change, as a fraction of the parent's radius.
  double min_scale = 0.95;  // The smallest and the largest factor on a radius in one change.
  double max_scale = 1.053;
  int first_trials = 40;  // The number of changes that are tried to find the first temperature.
  // The probability with which a mean rise of the energy is accepted at the first temperature. The text says "high"
  // without a number.
  double first_acceptance = 0.9;
  // The numbers of accepted and rejected changes at one temperature. The first one that is reached ends the
  // temperature.
  int max_accepted = 200, max_rejected = 200;
  // The maximum number of changes at one temperature that uncover the surface. Such a change is tried again and counts
  // neither as accepted nor as rejected. The limit ends a temperature at which the path rule holds every sphere of a
  // set in place.
  int max_uncovering = 20'000;
  double cooling = 0.9;        // The factor from one temperature to the next.
  int iterations_first = 100;  // The number of temperatures on the first level.
  int iterations = 50;         // The number of temperatures on each further level.
  // Which redundant spheres of a level are removed before the others get children. The implementation in the text
  // removed independent ones.
  Selection redundancy = Selection::acyclic;
  Refinement refinement{};
  std::uint64_t seed = 1;
};

// Returns the parameters of an effort: at high effort the dissertation's schedule, which is AnnealingOptions{}, and at
// lower effort a share of it. The times are about 1 : 3 : 17.
AnnealingOptions annealing_options(Effort effort);

// AnnealingOptions::first_acceptance for anneal_tree(): so low that the annealing keeps what the builder found.
inline constexpr double kCoolStart = 0.05;

// Counts of the annealing.
struct AnnealingReport {
  std::uint64_t changes = 0;     // Changes that were tried.
  std::uint64_t uncovering = 0;  // Changes that were undone because they break the path rule, and tried again.
  std::uint64_t accepted = 0;    // Changes that were kept.
  Index redundant = 0;           // Spheres removed between levels.
};

// The result of annealed_tree().
struct AnnealingBuild {
  SphereTree tree;
  AnnealingReport report;
};

// Builds a tree by simulated annealing of the children of each node, from the top down (dissertation 5.3).
// On the first level, the children start as those of the octree; below, they start as the octants of the cube around
// their parent (Fig. 5.8) that meet the surface. With a branching other than 8, they start as that many boxes. A change
// moves and scales one child. A change that breaks the path rule is undone and tried again; the Metropolis criterion
// accepts or rejects the others. Redundant spheres are removed before they get children (5.3.4).
// The result is conservative. It is the same for a seed on any number of threads; because temperatures use exp(),
// another maths library may give another result. Throws InputError unless surface.solid(). Parents that have no
// triangle in common are annealed in parallel.
AnnealingBuild annealed_tree(const Surface& surface, const AnnealingOptions& options = {},
                             const Progress& progress = {});

// Makes a tree of any builder tighter by annealing the children of each node, from the top down (dissertation 8.2). The
// changes are those of annealed_tree(), from the tree's own spheres in place of octants, and each set of siblings ends
// as the best one that it has been: no set gets a larger energy than it had. Take kCoolStart as first_acceptance, or
// what the builder found is forgotten first. Precondition: the tree is conservative, nodes in breadth-first order; it
// stays so. `depth`, `branching`, `redundancy` and `refinement` have no meaning here. Bounds and inaccuracies become
// stale: call measure() afterwards. Throws InputError unless surface.solid(). Deterministic as above.
AnnealingReport anneal_tree(SphereTree& tree, const Surface& surface, const AnnealingOptions& options = {},
                            const Progress& progress = {});

}  // namespace orchard
