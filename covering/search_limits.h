#pragma once

// Limits of the branch-and-bound searches for the point of a sphere or ball that lies farthest outside a solid.

namespace orchard::detail {

// Evaluations of the signed distance. Far more than any sphere of a sensible tree needs: only adversarial input reaches
// it, and then the bounds stay valid.
inline constexpr int kMaxEvaluations = 200'000;
// Least width of the bounds, as a fraction of R: a thousand roundings of a coordinate in a float.
inline constexpr double kFinest = 1e-6;

}  // namespace orchard::detail
