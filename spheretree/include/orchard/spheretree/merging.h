#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

namespace orchard {

// How merged spheres come to cover the surface between the forming points.
enum class MergeClosing {
  refit,   // Siblings divide their parent's points among them and are fitted to them. What is uncovered then becomes
           // further points for a sphere to hold, which is fitted again. The result is conservative.
  growth,  // As in dissertation 6.3.1, spheres stay as merged; grow_to_cover() or cover() has to follow.
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
    Index removed = 0, split = 0;  // redundant spheres taken out, and loose ones split in their place
    Index uncovered_regions = 0;   // in the first round of closing
    int rounds = 0;                // of closing
    double growth = 0;             // by cover() at last, the largest, as a fraction of R
  };
  std::vector<Level> levels;  // below the root; with MergeClosing::refit
};

struct MergeBuild {
  SphereTree tree;
  MergeReport report;
};

// Builds a tree from a medial axis: the children of each node are the spheres of the medial vertices merged into it,
// merged pairwise along the axis by least cost until few enough remain. Where a node has fewer vertices than it takes,
// its surface points are merged in their place.
// With MergeClosing::refit, the merged spheres are only the start. Siblings divide their parent's points among them;
// spheres that do not pay go to where they help most, within a node and within a level. A node then has up to three
// times `branching` children (64 at most), and a level at most `branching` times the nodes of the one above. Each level
// is closed, rid of what is redundant and filled up again before it gets children. Throws InputError for a branching
// out of range or an axis without vertices. Parallel over the nodes of a level; the result does not depend on the
// thread count. Source: dissertation 6.3, and 8.2 for refit.
MergeBuild merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options = {},
                      const Progress& progress = {});

}  // namespace orchard
