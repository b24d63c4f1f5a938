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

// Closes the last level of a tree by least growth, in place of dissertation 6.3.2: each uncovered region that the
// boundary lemma finds goes to the ball that it costs least, as further points for that ball to hold, and the ball is
// fitted again to its points, centre and radius, rather than scaled. Cost is a power of the looseness. Only balls of
// that level and leaves above it change. What a few rounds leave open is closed by a little growth of all balls of the
// level and by cover(); so the tree is conservative afterwards. held[i]: the points that node i answers for; uncovered
// regions are added to them.
// A tightened level's closing (tightened/level_closing.h) finds candidates by the same rule, but is one round of many,
// between which the search goes on, and fits a ball to what it alone holds. Here a region goes down the tree to a leaf,
// which keeps every point that it was ever given, and the rounds go on to the end.
ClosingReport close_by_refitting(SphereTree& tree, const Surface& surface, std::vector<std::vector<Point>>& held,
                                 double power);

}  // namespace orchard::detail
