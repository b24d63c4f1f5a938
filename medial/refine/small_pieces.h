#pragma once
#include <vector>

#include "../balls/ball_complex.h"
#include "cover_guard.h"

namespace orchard::detail {

// Removes spikes (chains of edges without triangles that have a free end) and flakes (pieces of triangles) that hang on
// the rest by one vertex. They are removed if they reach no farther from this vertex than `kPieceReach` times its
// radius, or if all their balls have radius 0. Cells that the topology needs, or that `guard` (if given) needs, stay.
// So do pieces that no longer hang on anything after that. Returns the number of removed cells. If `around` is given,
// spheres are added to it that hold all balls of these. O(n log n).
Index drop_small_pieces(BallComplex& complex, const CoverGuard* guard = nullptr, std::vector<Sphere>* around = nullptr);
inline constexpr double kPieceReach = 2;

}  // namespace orchard::detail
