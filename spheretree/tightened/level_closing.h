#pragma once
#include <vector>

#include "level_balls.h"
#include "level_objective.h"
#include "uncovered_regions.h"

namespace orchard::detail {

// One round of closing a tightened level, that is, of covering what its samples missed. Each uncovered region is given
// to the ball for which it costs least. This ball is fitted again to the region and to the samples that no other ball
// holds, and the region's farthest point becomes a sample; with `hold`, so do points near the region's corners. If no
// path region contains the whole uncovered region, only its farthest point is given to a ball; if no path region
// contains even that, the region is left to the levels above.
// After this round the search may continue, and balls may give points back. The closing of a merged level
// (merging/merge_closing.h) finds candidates by the same rule, but down a tree, and runs all its rounds in one go.
void close_regions(const Surface& surface, const LevelObjective& objective,
                   const std::vector<UncoveredRegion>& uncovered, bool hold, LevelBalls& balls);

}  // namespace orchard::detail
