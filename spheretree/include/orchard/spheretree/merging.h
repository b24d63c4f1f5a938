#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// How merged spheres come to cover the surface between the forming points.
enum class MergeClosing {
  refit,   // least growth: siblings share their parent's points out and are fitted to them; what is uncovered then is
           // one more point for a sphere to hold, and it is fitted again. The result is conservative.
  growth,  // as in dissertation 6.3.1: spheres stay as merged; grow_to_cover() or cover() has to follow
};

struct MergeOptions {
  Index depth = 3;      // levels below the root
  Index branching = 8;  // 2..64: children of a node at most with growth, on average with refit
  Refinement refinement{};
  MergeClosing closing = MergeClosing::refit;
};

struct MergeReport {
  struct Level {
    Index spheres = 0;
    Index removed = 0, split = 0;  // redundant spheres, and loose ones in their place
    Index uncovered_regions = 0;   // in the first round of closing
    int rounds = 0;                // of closing
    double growth = 0;             // by cover() at last, the largest, as a fraction of R
  };
  std::vector<Level> levels;  // below the root; with MergeClosing::refit
};

// Dissertation 6.3: the children of each node are the spheres of the medial vertices merged into it, merged pairwise
// along the medial axis by least cost until few enough remain. Where a node has fewer vertices than it takes, its
// surface points are merged in their place. Parallel over the nodes of a level; the result does not depend on the
// thread count. Throws InputError for a branching out of range or an axis without vertices.
//
// With MergeClosing::refit, merging gives the start (8.2): siblings share their parent's points out, spheres that do
// not pay go to where they help most, within a node and, up to three times `branching` for a node (64 at most), within
// a level, which has at most `branching` times the nodes of the one above. Each level is closed, rid of what is
// redundant and filled up again before it gets children.
SphereTree merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options = {},
                      const Progress& progress = {}, MergeReport* report = nullptr);

}  // namespace orchard
