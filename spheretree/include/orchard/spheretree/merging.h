#pragma once
#include "orchard/geometry/progress.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/refinement.h"
#include "orchard/spheretree/tree.h"

// Builds sphere-trees by merging the balls of a medial axis.
namespace orchard {

// How merged spheres are changed so that they also cover the surface between the forming points.
enum class MergeClosing {
  // Siblings divide the points of their parent among them and are fitted to their points. Then each uncovered part
  // becomes further points for a sphere to contain, and the sphere is fitted again. The result is conservative.
  refit,
  // Spheres stay as merged, as in dissertation 6.3.1. The caller has to call grow_to_cover() or cover() afterwards.
  growth,
};

// The options of merge_tree().
struct MergeOptions {
  Index depth = 3;  // The number of levels below the root.
  // The number of children of a node, 2..64: the maximum with growth, the average with refit.
  Index branching = 8;
  Refinement refinement{};
  MergeClosing closing = MergeClosing::refit;
};

// Counts of each level that merge_tree() built.
struct MergeReport {
  struct Level {
    Index spheres = 0;
    Index removed = 0, split = 0;  // Redundant spheres that were removed, and loose ones split in their place.
    Index uncovered_regions = 0;   // The number of uncovered regions in the first round of closing.
    int rounds = 0;                // The number of rounds of closing.
    // The largest growth of a sphere by cover(), which covers the rest after these rounds, as a fraction of R.
    double growth = 0;
  };
  // The levels below the root; empty without MergeClosing::refit.
  std::vector<Level> levels;
};

// The result of merge_tree().
struct MergeBuild {
  SphereTree tree;
  MergeReport report;
};

// Builds a tree from a medial axis. The medial vertices of a node are merged pairwise along the axis by least cost
// until few enough remain, and the spheres of the merged vertices are the children of the node. Where a node has fewer
// vertices than it may have children, its surface points are merged instead.
// With MergeClosing::refit, the merged spheres are only the start. Siblings divide the points of their parent among
// them, and spheres that contribute little move to where they help most, within a node and within a level. A node then
// has up to three times `branching` children (64 at most), and a level at most `branching` times the nodes of the one
// above. Each level is closed, its redundant spheres are removed and replaced, and then it gets children.
// Throws InputError for a branching out of range or an axis without vertices. The work is parallel over the nodes of a
// level; the result does not depend on the number of threads. Source: dissertation 6.3, and 8.2 for refit.
MergeBuild merge_tree(const Surface& surface, const MedialAxis& axis, const MergeOptions& options = {},
                      const Progress& progress = {});

}  // namespace orchard
