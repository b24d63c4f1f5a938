#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/spheretree/effort.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

// Builds the tightest sphere-trees, level by level.
namespace orchard {

// The quantity that is kept low on every level: the largest inaccuracy, the mean one, the volume outside the object, or
// a balance. Each objective is a sum over the level of powers of the inaccuracy.
//   balanced A high power at the top and low ones below, where they rise steeply beyond about twice the mean, and a
//            small power of the radius.
//   maximum  A high power.
//   mean     A low power.
//   volume   A low power times a power of the radius.
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
  // The times are about 1 : 2 : 6. High effort first builds the tree of standard effort. Then it searches further
  // covers of each level, in which balls looser than that tree's loosest cost a thousand times as much, and takes a
  // cover only if neither its mean nor its maximum nor its outside volume is above that tree's.
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
    // Regions between the samples that were uncovered in the first round of closing.
    Index uncovered_regions = 0;
    // The largest growth by cover(), which closes what is left, as a fraction of R.
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

// Builds a tight tree by solving each level as a whole: branching^level balls cover the whole surface, and every ball
// is free to choose its parent. A parent may have up to kMaxFanOut children with up to three levels, fewer with more
// levels, and at least up to twice `branching`.
// 1. Balls are fitted to surface points so that max |p - c| + sd(c) is small over the centre c, and improved by Lloyd's
//    iteration and large-neighbourhood search.
// 2. The boundary lemma finds uncovered regions. Each one is given to the ball whose cost rises least, until there is
//    none.
// 3. Each ball is fitted again to exactly what no other ball contains. At high effort, the search continues with
//    nothing uncovered.
// No level is looser than the one above it or than the octree's levels with as many spheres or fewer, in the mean or
// the maximum by more than 1e-4 R, unless the tree is refined in parts only. A level of more than 1000 balls is
// searched no longer than one of 1000.
//
// There should be at least 20 surface points for each ball of the last level. Points that gap repair added are not
// used. The result is conservative and, since work is counted and not timed, the same on any number of threads. The
// search uses a frame that is computed from the mesh (spheretree/canonical_frame.h). So, with the same points, a mesh
// that is scaled or moved gets the same tree up to the last digits, unless a corner or a point is so near to the border
// between two lattice points that its rounding decides the side.
// Throws InputError as require_sizes() does and if there are no points, and Error as validate() of a sampling does.
TightenBuild tightened_tree(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options = {},
                            const Progress& progress = {});

}  // namespace orchard
