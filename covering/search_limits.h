#pragma once

// Limits of the branch-and-bound searches for the point of a sphere or ball that lies farthest outside a solid.

namespace orchard::detail {

// The maximum number of evaluations of the signed distance. Only artificial input needs so many. If a search reaches
// the limit, its bounds are still valid.
inline constexpr int kMaxEvaluations = 200'000;
// The smallest width of the bounds, as a fraction of R: a thousand times the rounding error of a coordinate in a float.
inline constexpr double kFinest = 1e-6;

}  // namespace orchard::detail
