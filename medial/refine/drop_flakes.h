#pragma once
#include <vector>

#include "ball_complex.h"
#include "cover_guard.h"

namespace orchard::detail {

// Takes away flakes: sheets that one edge joins to the rest, at which others meet, and that reach no farther from its
// ends than kPieceReach times the larger one's radius; but for what the topology needs, and what `guard`, if
// given, holds. Returns how many triangles went. O(n log n). Adds spheres to `around`, if given, that hold all balls of
// these.
Index drop_flakes(BallComplex& complex, const CoverGuard* guard = nullptr, std::vector<Sphere>* around = nullptr);

}  // namespace orchard::detail
