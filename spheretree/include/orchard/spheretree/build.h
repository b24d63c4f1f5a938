#pragma once
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "orchard/medial/build.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/spheretree/annealing.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/descent.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/redundancy.h"
#include "orchard/spheretree/tightened.h"
#include "orchard/spheretree/tree.h"
#include "orchard/spheretree/verify.h"

// Builds a certified sphere-tree of a surface in one call, from the mesh to the packed tree and its proof.
namespace orchard {

// The builder of a tree and its options: the alternative that is held says which builder runs. The builders are those
// of tightened.h, merging.h, annealing.h and octree.h.
using TreeOptions = std::variant<TightenOptions, MergeOptions, AnnealingOptions, OctreeOptions>;

// The builders, in the order of TreeOptions.
enum class TreeMethod { tightened, merging, annealing, octree };

// Returns the builder that runs with these options.
TreeMethod method_of(const TreeOptions& options);

// Returns the maximum number of levels below the root. It is `depth`, or the count of numbers in
// TightenOptions::spheres where there are any.
Index depth_of(const TreeOptions& options);

// Returns true if the method starts from points of the surface or from a medial axis built from them, as tightened and
// merging do.
bool samples_surface(TreeMethod method);

// Returns how many surface points a method needs for its depth: 5000, but for tightened trees 20 for each ball of the
// last level, within 10,000 and 200,000. The number does not depend on the effort, because high effort starts from the
// tree of standard effort.
Index samples_needed(const TreeOptions& options);

// Checks the branching and the numbers of spheres. Throws InputError if they are out of the method's range.
// build_sphere_tree() makes this check before all other work.
void require_sizes(const TreeOptions& options);

// The options of build_sphere_tree(), by stage.
struct SphereTreeOptions {
  // The points on the surface, and the medial axis. tree.seed is another seed than medial.sampling.seed.
  MedialBuildOptions medial{};
  // Whether the build uses samples_needed() surface points, a fifth of them along edges, in place of the numbers in
  // medial.sampling. A deep tree needs more points than an axis does.
  bool samples_by_need = true;
  // Tightened trees: whether a medial axis is built, too. The tree is fitted to surface points alone and is the same
  // without the axis, and the build is faster. Other methods ignore this option.
  bool axis = true;
  TreeOptions tree{};
  // Which redundant spheres are removed from the finished tree; `exhaustive` removes the most. Annealing also removes
  // spheres between its levels: AnnealingOptions::redundancy.
  Selection redundancy = Selection::exhaustive;
  // The options of anneal_tree(), which then anneals each set of siblings of the finished tree, after any method but
  // annealing itself. Take kCoolStart as first_acceptance.
  std::optional<AnnealingOptions> anneal{};
  // The options of random_descent(), which then runs after any method.
  std::optional<DescentOptions> descent{};
};

// The results of all stages of a build, and the time of each stage.
struct SphereTreeBuild {
  // The builder that ran, and its options. build_sphere_tree_within() chooses them itself.
  TreeOptions tree_options;
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
// effort, and of high effort with further seeds, until the time is used up. options.tree has to hold TightenOptions, of
// which the effort is ignored.
// The result depends on the speed of the machine. The limit is checked at each report of progress, which comes within
// about a second for meshes of a few thousand triangles. Throws as build_sphere_tree() does, and InputError if the
// limit is negative or not a number or if options.tree holds the options of another builder.
SphereTreeBuild build_sphere_tree_within(double seconds, const Surface& surface, const SphereTreeOptions& options = {},
                                         const Progress& progress = {}, const MedialBuildInput& input = {});

}  // namespace orchard
