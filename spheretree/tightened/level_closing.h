#pragma once
#include <vector>

#include "level_balls.h"
#include "level_objective.h"
#include "uncovered_regions.h"

namespace orchard::detail {

// How a level takes in what its samples missed: each uncovered region goes to the ball that it costs least, which is
// fitted again to it and to the samples that it alone holds, and the region's farthest point becomes a sample. With
// `hold`, points near its corners do too. An uncovered region that lies in no path region as a whole goes by its
// farthest point alone; where not even that has a ball, it is left for the levels above to mend.
// The closing of a merged level (merging/merge_closing.h) finds candidates by the same rule, but down a tree, and runs
// its rounds to the end. This is one round, after which the search may go on and balls may let go of what they took in.
void close_regions(const Surface& surface, const LevelObjective& objective,
                   const std::vector<UncoveredRegion>& uncovered, bool hold, LevelBalls& balls);

}  // namespace orchard::detail
