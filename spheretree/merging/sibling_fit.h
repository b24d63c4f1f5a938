#pragma once
#include <span>
#include <vector>

#include "ball_fit.h"

namespace orchard::detail {

// The balls of siblings and the points of their parent that each answers for; every point has one ball.
struct Siblings {
  std::vector<FittedBall> balls;
  std::vector<Index> owner;  // of each point: a ball
};

// Divides the points among `wanted` siblings and fits each ball to its own, so that the sum of a power of the looseness
// is low. By turns at first, each point to the ball that gets least loose by it; balls that there are too many of go,
// the cheapest to lose first; then as long as it helps, one ball goes and the loosest of the others becomes two. From
// each of several sets of balls to start with; the best counts. No ball is left without points, so there may be fewer
// than wanted. `patient`: trials that fall too slowly go on as well. Precondition: there is a point, a set, and a ball
// in it.
Siblings fit_siblings(const Surface& surface, const std::vector<Point>& points,
                      std::span<const std::vector<FittedBall>> starts, std::size_t wanted, double power, bool patient);

}  // namespace orchard::detail
