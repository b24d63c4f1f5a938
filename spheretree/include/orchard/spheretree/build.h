#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "orchard/medial/build.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/annealing.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/descent.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/redundancy.h"
#include "orchard/spheretree/tightened.h"
#include "orchard/spheretree/tree.h"
#include "orchard/spheretree/verify.h"

namespace orchard {

enum class TreeMethod { tightened, merging, annealing, octree };

// Numbers of the annealing in place of those that the effort stands for.
struct AnnealingTuning {
  std::optional<double> move, min_scale, max_scale, first_acceptance, cooling;
  std::optional<int> first_trials, max_accepted, max_rejected, max_uncovering, iterations_first, iterations;
};

// All that can be tuned on the way from a surface to a certified tree.
struct SphereTreeOptions {
  TreeMethod method = TreeMethod::tightened;
  Index depth = 3;               // levels below the root at most
  Index branching = 8;           // children of a node at most or on average, as the method has it
  std::vector<Index> spheres{};  // tightened: how many each level may have, in place of `branching`; see TightenOptions
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;  // tightened
  SetEnergy energy = SetEnergy::maximum;      // annealing, the three
  SphereEnergy distance = SphereEnergy::lemma;
  AnnealingTuning annealing{};
  // Which spheres that others make needless go at the end; annealing: between levels, too, but for `exhaustive`, which
  // stands for `acyclic` there.
  Selection redundancy = Selection::exhaustive;
  MergeClosing closing = MergeClosing::refit;  // merging
  Refinement refinement{};
  Index descent = 0;       // trials of random descent for each node, after any method
  bool anneal = false;     // whether to anneal each set of siblings afterwards (anneal_tree), after any other method
  std::uint64_t seed = 1;  // of the tree's own random choices; medial.sampling has its own
  MedialBuildOptions medial{};
  // tightened: whether to make a medial axis, too. The tree is the same without, and there sooner, for it is fitted to
  // surface points alone; other methods have an axis or not, whatever this says.
  bool axis = true;
  // Whether to take samples_needed() surface points, a fifth of them along edges, in place of the numbers in
  // medial.sampling: a deep tree needs more than an axis does.
  bool samples_by_need = true;
};

// Whether the method starts from points of the surface, or from a medial axis made of them.
bool samples_surface(TreeMethod method);

// What the annealing runs with: the dissertation's schedule with high effort, otherwise a share of it, and the tuning.
// Of a tree that there is already, the first acceptance is 0.05 unless the tuning says otherwise.
AnnealingOptions annealing_options(const SphereTreeOptions& options);

// How many surface points a method and its depth need: 5000, or for tightened trees 20 for each ball of the last level,
// 10,000 at least and 200,000 at most, whatever the effort, so that high effort has the tree of standard effort to
// begin with.
Index samples_needed(const SphereTreeOptions& options);

// Throws InputError for a branching or numbers of spheres that are out of the method's range; building does so before
// anything else.
void require_sizes(const SphereTreeOptions& options);

// Everything that one run from a surface to a packed tree made, and how long each stage took.
struct SphereTreeBuild {
  // Of the options, those that build_sphere_tree_within() chooses by itself.
  TreeMethod method = TreeMethod::tightened;
  Effort effort = Effort::standard;
  std::uint64_t seed = 1;
  Index points = 0;  // of the surface, that it started from; without those of gap repair
  // Empty for an octree, annealing, and where options.axis did without. Of the points that a tightened tree is fitted
  // to, unless it is refined: then points are added to its own.
  std::optional<MedialBuild> medial;
  Index axis_components = 0;
  SphereTree tree;
  SphereTree octree;  // of the same depth, to compare with: measured for its inaccuracy alone
  TightenReport tightening;
  MergeReport merging;
  AnnealingReport annealing;  // also of options.anneal
  DescentReport descent;
  CoverReport cover;
  RedundancyReport redundancy;
  runtime::PackedSphereTree packed;
  Verification certificate;   // of the packed tree; always ok()
  Index bounds_weakened = 0;  // nodes with a bound that is weaker than measured, since only that is proven
  StageTimes seconds;         // stage, time; those of the medial axis among them
};

// Builds a certified tree of a surface: medial axis, tree, covering, removal of redundant spheres, bounds, packing,
// verification. The result is conservative, and the same for the same surface, options and input whatever the number of
// threads. A mesh that is scaled or moved gets the same tree but for the last digits, unless it is merged or a corner
// is as near to the border between two lattice points (spheretree/canonical_frame.h) as its digits reach; scaled by a
// power of two, the same but for the scale. Throws InputError if the surface or an option does not allow it, and Error
// if the packed tree fails its certificate. Three levels take some seconds; see docs/results/benchmarks.md.
SphereTreeBuild build_sphere_tree(const Surface& surface, const SphereTreeOptions& options = {},
                                  const Progress& progress = {}, MedialBuildInput input = {});

// The tightest certified tree, by overall_inaccuracy(), that there is after some seconds: the octree first, which takes
// its time whatever the limit, then tightened trees of low, standard and high effort, and of high effort with further
// seeds, as long as there is time. The method and the effort of the options do not count. What comes out depends on the
// machine's speed. A limit that is met is noticed at the next report of progress, within a second or so for meshes of a
// few thousand triangles. Errors as above, and of a limit that is negative or not a number.
SphereTreeBuild build_sphere_tree_within(double seconds, const Surface& surface, const SphereTreeOptions& options = {},
                                         const Progress& progress = {}, const MedialBuildInput& input = {});

}  // namespace orchard
