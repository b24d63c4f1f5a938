#pragma once
#include <vector>

#include "level_balls.h"
#include "level_cover.h"

namespace orchard::detail {

// Part of a covering ball's looseness that must go for a tighter fit to be worth the change.
inline constexpr double kWorthwhileTightening = 1e-4;

std::vector<Point> ends_of(const std::vector<OpenArc>& arcs);

// Fits each ball, the loosest first, to the samples that it alone holds, where that makes it tighter.
void tighten_to_samples(const Surface& surface, LevelBalls& balls);

// Fits each ball, the loosest first, to the surface that it alone covers, where that makes it tighter; nothing is
// uncovered by that. `cover` holds the same balls, before and after.
void tighten_to_surface(const Surface& surface, LevelBalls& balls, LevelCover& cover);

}  // namespace orchard::detail
