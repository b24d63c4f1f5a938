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

// Builds a certified sphere-tree of a surface in one call, from the mesh to the packed tree and its proof.
namespace orchard {

// The builder of the tree: tightened.h, merging.h, annealing.h or octree.h.
enum class TreeMethod { tightened, merging, annealing, octree };

// Parameters of the annealing that replace those which the effort stands for. AnnealingOptions describes each of them;
// those without a value keep the number of the effort.
struct AnnealingTuning {
  std::optional<double> move, min_scale, max_scale, first_acceptance, cooling;
  std::optional<int> first_trials, max_accepted, max_rejected, max_uncovering, iterations_first, iterations;
};

// The options of build_sphere_tree().
struct SphereTreeOptions {
  TreeMethod method = TreeMethod::tightened;
  Index depth = 3;  // The maximum number of levels below the root.
  // The number of children of a node: the maximum or the average, depending on the method.
  Index branching = 8;
  // tightened: the maximum number of spheres of each level, which replaces `branching`; see TightenOptions.
  std::vector<Index> spheres{};
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;    // tightened: the quantity that is kept low on every level.
  SetEnergy energy = SetEnergy::maximum;        // annealing: the energy of a set of siblings.
  SphereEnergy distance = SphereEnergy::lemma;  // annealing: the energy of one sphere.
  AnnealingTuning annealing{};                  // annealing: single parameters.
  // Which redundant spheres are removed from the finished tree; `exhaustive` removes the most. Annealing also removes
  // spheres between its levels, by the same selection, with `acyclic` in place of `exhaustive`.
  Selection redundancy = Selection::exhaustive;
  MergeClosing closing = MergeClosing::refit;  // merging: how the spheres come to cover the surface.
  Refinement refinement{};                     // Where the tree goes deeper.
  // The number of trials of random descent for each node, after any method; 0 runs none. See descent.h.
  Index descent = 0;
  // Whether each set of siblings is annealed afterwards (anneal_tree()), after any method but annealing itself.
  bool anneal = false;
  // The seed of the tree's own random choices. medial.sampling has a seed of its own.
  std::uint64_t seed = 1;
  MedialBuildOptions medial{};
  // tightened: whether a medial axis is built, too. The tree is fitted to surface points alone and is the same without
  // the axis, and the build is faster. Other methods ignore this option.
  bool axis = true;
  // Whether the build uses samples_needed() surface points, a fifth of them along edges, in place of the numbers in
  // medial.sampling. A deep tree needs more points than an axis does.
  bool samples_by_need = true;
};

// Returns true if the method starts from points of the surface or from a medial axis built from them, as tightened and
// merging do.
bool samples_surface(TreeMethod method);

// Returns the parameters that the annealing runs with: with high effort the dissertation's schedule, with lower effort
// a share of it, and in both cases the values of options.annealing where they are given.
// For a tree that exists already the first acceptance is 0.05 unless options.annealing says otherwise.
AnnealingOptions annealing_options(const SphereTreeOptions& options);

// Returns how many surface points a method needs for its depth: 5000, but for tightened trees 20 for each ball of the
// last level, within 10,000 and 200,000. The number does not depend on the effort, because high effort starts from the
// tree of standard effort.
Index samples_needed(const SphereTreeOptions& options);

// Checks the branching and the numbers of spheres. Throws InputError if they are out of the method's range.
// build_sphere_tree() makes this check before all other work.
void require_sizes(const SphereTreeOptions& options);

// The results of all stages of a build, and the time of each stage.
struct SphereTreeBuild {
  // These three are the options that were used; build_sphere_tree_within() chooses them itself.
  TreeMethod method = TreeMethod::tightened;
  Effort effort = Effort::standard;
  std::uint64_t seed = 1;
  // The number of surface points that the build started from, without those that gap repair added.
  Index points = 0;
  // The medial axis. There is none for an octree or annealing, nor if options.axis is false. It is built from the
  // points that a tightened tree is fitted to, unless the axis is refined, which adds further points.
  std::optional<MedialBuild> medial;
  Index axis_components = 0;
  SphereTree tree;
  // An octree of the same depth for comparison. Only its inaccuracies are measured.
  SphereTree octree;
  TightenReport tightening;
  MergeReport merging;
  AnnealingReport annealing;  // also of options.anneal
  DescentReport descent;
  CoverReport cover;
  RedundancyReport redundancy;
  runtime::PackedSphereTree packed;
  Verification certificate;  // The proof of the packed tree; ok() always holds.
  // The number of nodes that store a weaker bound than the measured one, because only the weaker one is proven.
  Index bounds_weakened = 0;
  // The name and the duration of each stage, those of the medial axis included.
  StageTimes seconds;
};

// Builds a certified sphere-tree of a surface in these stages: medial axis, tree, covering, removal of redundant
// spheres, bounds, packing, verification. `input` may replace the first stages of the medial axis.
// The tree is conservative. It is the same for the same surface, options and input on any number of threads. If the
// mesh is scaled by a power of two, the tree differs in its scale only. If the mesh is scaled otherwise or moved, the
// tree is the same up to the last digits, except for merged trees and for meshes with a corner so near to the border
// between two lattice points (spheretree/canonical_frame.h) that its rounding decides the side.
// Throws InputError if the surface or an option does not allow the build, and Error if the packed tree fails its
// verification. Three levels take some seconds; see docs/results/benchmarks.md.
SphereTreeBuild build_sphere_tree(const Surface& surface, const SphereTreeOptions& options = {},
                                  const Progress& progress = {}, MedialBuildInput input = {});

// Builds the tightest certified tree, measured by overall_inaccuracy(), that it finds within a time limit in seconds.
// It builds the octree first, which is finished whatever the limit, and then tightened trees of low, standard and high
// effort, and of high effort with further seeds, until the time is used up. It ignores options.method and
// options.effort.
// The result depends on the speed of the machine. The limit is checked at each report of progress, which comes within
// about a second for meshes of a few thousand triangles. Throws as build_sphere_tree() does, and InputError if the
// limit is negative or not a number.
SphereTreeBuild build_sphere_tree_within(double seconds, const Surface& surface, const SphereTreeOptions& options = {},
                                         const Progress& progress = {}, const MedialBuildInput& input = {});

}  // namespace orchard
