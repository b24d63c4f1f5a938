#pragma once
#include <vector>

#include "level_balls.h"
#include "level_options.h"

namespace orchard::detail {

// The balls that a level starts with, each fitted to samples of one path region; every sample that there was room for
// is held. Each seed is put where the balls so far would have to be loosest; then Lloyd's iteration in the distance |p
// - c| + sd(c): a sample goes to the ball that gets least loose by it, and each ball is fitted to its own. There may be
// fewer balls than options.balls, and there are none without samples. The balls' lists of samples are left empty.
std::vector<LevelBall> seeded_balls(const Surface& surface, const PathRegions& regions, const LevelOptions& options);

// The same from balls that were fitted to other samples of the same surface, in the place of seeds.
std::vector<LevelBall> relaxed_balls(const Surface& surface, const PathRegions& regions, const LevelOptions& options,
                                     std::vector<LevelBall> balls);

}  // namespace orchard::detail
