#pragma once
#include <vector>

#include "level_balls.h"
#include "level_cover.h"

namespace orchard::detail {

// A tighter fit of a covering ball is accepted only if its looseness falls by at least this part.
inline constexpr double kWorthwhileTightening = 1e-4;

std::vector<Point> ends_of(const std::vector<OpenArc>& arcs);

// Fits each ball, the loosest first, to the samples that no other ball holds, if that makes it tighter.
void tighten_to_samples(const Surface& surface, LevelBalls& balls);

// Fits each ball, the loosest first, to the part of the surface that no other ball covers, if that makes it tighter.
// The level covers the surface afterwards as before. `cover` must hold the same balls, and does so afterwards.
void tighten_to_surface(const Surface& surface, LevelBalls& balls, LevelCover& cover);

}  // namespace orchard::detail
