#pragma once
#include <vector>

#include "../balls/ball_complex.h"
#include "cover_guard.h"

namespace orchard::detail {

// Takes away spikes and flakes: chains of edges without triangles that end freely, and pieces of triangles, that hang
// on the rest by one vertex and reach no farther from it than `kPieceReach` times its radius, or have no ball of radius
// above 0; but for what the topology needs, and what `guard`, if given, holds. Pieces that are left by that hang on
// nothing stay. Returns how many cells went. O(n log n). Adds spheres to `around`, if given, that hold all balls of
// these.
Index drop_small_pieces(BallComplex& complex, const CoverGuard* guard = nullptr, std::vector<Sphere>* around = nullptr);
inline constexpr double kPieceReach = 2;

}  // namespace orchard::detail
