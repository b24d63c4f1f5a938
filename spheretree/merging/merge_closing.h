#pragma once
#include <vector>

#include "orchard/geometry/surface.h"
#include "orchard/spheretree/tree.h"

namespace orchard::detail {

// Closes the last level of a tree by least growth, beside dissertation 6.3.2: each region that the boundary lemma finds
// uncovered goes to the ball that it costs least, as a further point for that ball to hold, and the ball is fitted
// again to its points, centre and radius, rather than scaled. Only balls of that level and leaves above it change.
// Cost is a power of the looseness.
// held[i]: the points that node i answers for; regions are added to them. What a few rounds leave open, little growth
// of all balls of the level and cover() close; so the tree is conservative afterwards.
struct ClosingReport {
  int rounds = 0;
  Index regions = 0;  // in the first round
  double growth = 0;  // by cover(), the largest, as a fraction of R
};
ClosingReport close_level(SphereTree& tree, const Surface& surface, std::vector<std::vector<Point>>& held,
                          double power);

}  // namespace orchard::detail
