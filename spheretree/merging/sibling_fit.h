#pragma once
#include <span>
#include <vector>

#include "ball_fit.h"

namespace orchard::detail {

// The balls of siblings, with the points of their parent divided among them. Every point belongs to one ball.
struct Siblings {
  std::vector<FittedBall> balls;
  std::vector<Index> owner;  // the ball of each point
};

// Divides the points among up to `wanted` siblings and fits each ball to its points, such that the sum of a power of
// the looseness is small. The steps are repeated for each of several initial sets of balls, and the best result is
// returned:
// 1. Points are assigned and balls are fitted in turns. Each point goes to the ball that becomes least loose by it.
// 2. If there are too many balls, balls are removed, first those whose removal costs least.
// 3. As long as it helps, one ball is removed and the loosest of the others is divided into two.
// Balls without points are removed, so there may be fewer than `wanted`. With `patient`, trials continue even if their
// cost falls slowly. Precondition: there is at least one point and one initial set, and no set is empty.
Siblings fit_siblings(const Surface& surface, const std::vector<Point>& points,
                      std::span<const std::vector<FittedBall>> starts, std::size_t wanted, double power, bool patient);

}  // namespace orchard::detail
