#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

struct ClosingReport {
  int rounds = 0;
  Index uncovered_regions = 0;  // in the first round
  double growth = 0;            // by cover(), the largest, as a fraction of R
};

// Closes the last level of a tree by least growth, which replaces the scaling of dissertation 6.3.2. The points of each
// uncovered region that the boundary lemma finds are given to the ball for which they cost least; the cost is a power
// of the looseness. That ball's centre and radius are then fitted again to all of its points. Only balls of that level,
// and leaves above it, change. What is still open after a few rounds is closed by growing all balls of the level a
// little and by cover(), so the tree is conservative afterwards. held[i]: the points that node i must hold; points of
// uncovered regions are added to them.
// The closing of a tightened level (tightened/level_closing.h) chooses candidates by the same rule, but there one round
// alternates with the search, and a ball is fitted only to what no other ball holds. Here a region goes down the tree
// to a leaf, a leaf keeps every point that it was ever given, and all rounds follow each other.
ClosingReport close_by_refitting(SphereTree& tree, const Surface& surface, std::vector<std::vector<Point>>& held,
                                 double power);

}  // namespace orchard::detail
