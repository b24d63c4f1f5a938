#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/geometry/sampling.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// How long to search: about 1 : 2 : 6 in time. High effort first builds the tree of standard effort. Then it searches
// further covers of each level, in which balls looser than that tree's loosest cost a thousand times as much, and takes
// a cover only if neither its mean nor its maximum nor its outside volume is above that tree's.
enum class Effort { low, standard, high };

// What is to be low on every level: the largest inaccuracy, the mean one, the volume outside the object, or a balance.
// Each is a sum over the level of powers of the inaccuracy: `maximum` has a high power, `mean` a low one, `volume` has
// a power of the radius as well, and `balanced` a high power at the top and low ones below, where they rise steeply
// beyond about twice the mean, and a small power of the radius.
enum class Objective { balanced, maximum, mean, volume };

inline constexpr Index kMaxBranching = 1024;
inline constexpr Index kMaxFanOut = 64;  // children of a node, as its level's spheres are divided by need

struct TightenOptions {
  // Levels below the root at most: there are fewer where the surface points do not suffice for another level with half
  // as many spheres again as the one above.
  Index depth = 3;
  Index branching = 8;  // a level has at most this many times the nodes of the one above; 2..kMaxBranching
  // How many spheres each level may have, in place of `branching`; empty, or `depth` numbers, each above the one before
  // and at most kMaxFanOut times it, the first one between 2 and kMaxBranching. Spheres go where they help: a parent
  // has as many of its level's as it is worth.
  std::vector<Index> spheres{};
  Effort effort = Effort::standard;
  Objective objective = Objective::balanced;
  Refinement refinement{};
  std::uint64_t seed = 1;
};

struct TightenReport {
  struct Level {
    Index balls = 0;
    Index closing_rounds = 0;
    Index uncovered_regions = 0;  // that the samples had left, in the first round of closing
    double grown = 0;             // by cover(), the last resort: the largest growth, as a fraction of R
    double seconds_search = 0, seconds_closing = 0;
  };
  std::vector<Level> levels;
};

struct TightenBuild {
  SphereTree tree;
  TightenReport report;
};

// Throws InputError for a branching or numbers of spheres out of range.
void require_sizes(const TightenOptions& options);

// Builds the tightest trees: each level is solved as a whole, with branching^level balls for the whole surface and
// every ball free to choose its parent. A parent so has as many children as it is worth, kMaxFanOut at most with up to
// three levels, fewer with more, and at least up to twice `branching`; the load balances itself. Balls are fitted to
// surface points, so that max |p - c| + sd(c) is small over the centre c, improved by Lloyd's iteration and large-
// neighbourhood search, and closed with the boundary lemma: each uncovered region is given to the ball that it costs
// least, until there is none. Then each ball is fitted again to exactly what it alone holds, and at high effort the
// search goes on with nothing uncovered. No level is looser than the one above it or than the octree's levels with as
// many spheres or fewer, in the mean or the maximum by more than 1e-4 R, unless the tree is refined in parts only. A
// level of more than 1000 balls is searched no longer than one of 1000. There should be 20 surface points or more for
// each ball of the last level; those that gap repair added are left out. The result is conservative and, since work is
// counted and not timed, the same on any number of threads. The search runs on the mesh as it is in a frame of its own
// (spheretree/canonical_frame.h), so that with the same points a mesh that is scaled or moved gets the same tree but
// for the last digits, unless a corner or a point is as near to the border between two lattice points as its digits
// reach. Throws InputError as require_sizes() does, and where there are no points; Error as validate() of a sampling
// does.
TightenBuild tightened_tree(const Surface& surface, const SurfaceSampling& sampling, const TightenOptions& options = {},
                            const Progress& progress = {});

}  // namespace orchard
