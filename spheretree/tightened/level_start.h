#pragma once
#include <vector>

#include "level_balls.h"
#include "level_options.h"

namespace orchard::detail {

// Returns the balls that a level starts with, each fitted to samples of one path region. Every sample for which there
// was room is contained. Each new ball is placed where the balls so far would have to be loosest. Then Lloyd's
// iteration follows, with the distance |p - c| + sd(c): a sample goes to the ball that becomes least loose by it, and
// each ball is fitted to its samples. There may be fewer balls than options.balls, and there are none without samples.
// The balls' lists of samples are left empty.
std::vector<LevelBall> seeded_balls(const Surface& surface, const PathRegions& regions, const LevelOptions& options);

// The same, starting from balls that were fitted to other samples of the same surface.
std::vector<LevelBall> relaxed_balls(const Surface& surface, const PathRegions& regions, const LevelOptions& options,
                                     std::vector<LevelBall> balls);

}  // namespace orchard::detail
