#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/spheretree/effort.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

// Builds the tightest sphere-trees, level by level.
namespace orchard {

// The quantity that is minimised on every level: the largest inaccuracy, the mean inaccuracy, the volume outside the
// object, or a compromise between these. The cost of a level is a sum over its balls of powers of the inaccuracy:
//   maximum  A high power.
//   mean     A low power.
//   volume   A low power times a power of the radius.
//   balanced A high power on the upper levels and a low power on the lower ones, times a small power of the radius. On
//            the lower levels, an additional factor rises steeply above about twice the mean.
enum class Objective { balanced, maximum, mean, volume };

// The largest branching of a tightened tree.
inline constexpr Index kMaxBranching = 1024;
// The largest number of children of a node, because the spheres of a level are divided among the nodes by need.
inline constexpr Index kMaxFanOut = 64;

// The options of tightened_tree().
struct TightenOptions {
  // The maximum number of levels below the root. There are fewer levels if the surface points do not suffice for
  // another level with half as many spheres again as the one above.
  Index depth = 3;
  // A level has at most this many times the nodes of the one above; 2..kMaxBranching.
  Index branching = 8;
  // The maximum number of spheres of each level, in place of `branching`. It is empty or contains `depth` numbers; the
  // first one is between 2 and kMaxBranching, and each other one is above the one before and at most kMaxFanOut times
  // it. The spheres of a level are given to the parents that gain most from them.
  std::vector<Index> spheres{};
  // Low, standard and high effort take time in proportions of about 1 : 2 : 6. High effort first builds the tree of
  // standard effort. Then it searches for better covers of each level. In this search, balls that are looser than the
  // loosest ball of the first tree cost a thousand times as much, and a cover is accepted only if its mean, its maximum
  // and its outside volume are not above those of the first tree.
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;
  Refinement refinement{};
  std::uint64_t seed = 1;
};

// Measures of each level.
struct TightenReport {
  struct Level {
    Index balls = 0;
    Index closing_rounds = 0;
    // The number of regions between the samples that were uncovered in the first round of closing.
    Index uncovered_regions = 0;
    // The largest growth of a ball by cover(), which covers the rest after these rounds, as a fraction of R.
    double grown = 0;
    double seconds_search = 0, seconds_closing = 0;
  };
  std::vector<Level> levels;
};

// The result of tightened_tree().
struct TightenBuild {
  SphereTree tree;
  TightenReport report;
};

// Throws InputError for a branching or numbers of spheres out of range.
void require_sizes(const TightenOptions& options);

// Builds a tight tree by solving each level as a whole: up to branching^level balls cover the whole surface, and each
// ball may get any parent. A parent may have up to kMaxFanOut children in trees of up to three levels. In deeper trees
// the limit is lower, but not below twice `branching`.
// 1. Balls are fitted to surface points so that max |p - c| + sd(c) is small over the centre c, and improved by Lloyd's
//    iteration and large-neighbourhood search.
// 2. The boundary lemma finds uncovered regions. Each one is given to the ball whose cost rises least, until there is
//    none.
// 3. Each ball is fitted again to the part of the surface that no other ball contains. At high effort, the search then
//    continues among balls that cover the whole surface.
// Neither the mean nor the maximum inaccuracy of a level exceeds, by more than 1e-4 R, that of the level above or that
// of a level of the octree with at most as many spheres, unless only parts of the tree are refined. A level of more
// than 1000 balls is searched no longer than one of 1000.
//
// There should be at least 20 surface points for each ball of the last level. Points that gap repair added are not
// used. The result is conservative. It is the same on any number of threads, because work is counted and not timed. The
// search uses a frame that is computed from the mesh (spheretree/canonical_frame.h). So if a mesh and its points are
// scaled or moved, the tree is the same up to the last digits. In rare cases it is not: coordinates are rounded to a
// lattice, and a corner or point may be so near to the middle between two lattice points that rounding errors decide.
// Throws InputError as require_sizes() does and if there are no points, and Error as validate() of a sampling does.
TightenBuild tightened_tree(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options = {},
                            const Progress& progress = {});

}  // namespace orchard
