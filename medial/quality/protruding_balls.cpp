#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "quality_parts.h"

namespace orchard::detail {
namespace {

// The number of balls whose far sides are examined before checking whether more are needed.
constexpr std::size_t kFirstBalls = 256;

struct ProtrudingCandidate {
  double upper = 0;  // an upper bound on the protrusion, because the distance is 1-Lipschitz
  std::size_t number = 0;
};

}  // namespace

BallDepth depth_of(const Surface& surface, const Sphere& ball) {
  BallDepth result;
  result.signed_distance = surface.signed_distance(ball.center, result.nearest);
  return result;
}

std::vector<BallDepth> depths_of(const Surface& surface, std::span<const Sphere> balls) {
  std::vector<BallDepth> depths(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) { depths[i] = depth_of(surface, balls[i]); });
  return depths;
}

// Returns how far a ball protrudes at its point beyond the ball's nearest surface point. Where the surface is flat or
// convex, this is the farthest point outside. It is a point of the ball in any case, so the value is attained.
BallReach reach_of(const Surface& surface, const Sphere& ball, const BallDepth& depth) {
  BallReach reach{.beyond = 0, .farthest = ball.center};
  const ClosestPoint& nearest = depth.nearest;
  if (!(depth.signed_distance + ball.radius > 0)) return reach;  // the whole ball is inside
  if (!(nearest.distance > 0)) {
    reach.beyond = std::max(0.0, ball.radius);
    return reach;
  }
  const Vector outward = (depth.outside() ? 1.0 : -1.0) / nearest.distance * (ball.center - nearest.position);
  reach.farthest = ball.center + ball.radius * outward;
  reach.beyond = std::max(0.0, surface.signed_distance(reach.farthest));
  return reach;
}

// Examines the far sides of balls in the order of their upper bounds, until none of the rest can be among the worst.
std::vector<WorstPlace> worst_protrusions(const Surface& surface, std::span<const Sphere> balls,
                                          std::span<const BallDepth> depths, std::vector<WorstPlace> known, Index count,
                                          double apart, double negligible) {
  std::vector<ProtrudingCandidate> candidates;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const double upper = depths[i].signed_distance + balls[i].radius;
    if (upper > negligible) candidates.push_back({upper, i});
  }
  std::sort(candidates.begin(), candidates.end(), [](const ProtrudingCandidate& a, const ProtrudingCandidate& b) {
    return a.upper != b.upper ? a.upper > b.upper : a.number < b.number;
  });
  std::size_t looked_at = 0;
  for (std::size_t next = kFirstBalls;; next *= 2) {
    const std::size_t end = std::min(next, candidates.size());
    std::vector<WorstPlace> found(end - looked_at);
    tbb::parallel_for(looked_at, end, [&](std::size_t k) {
      const std::size_t i = candidates[k].number;
      const BallReach reach = reach_of(surface, balls[i], depths[i]);
      found[k - looked_at] = {WorstKind::protrusion, reach.beyond, reach.farthest, Vector::Zero(), balls[i]};
    });
    std::erase_if(found, [&](const WorstPlace& place) { return !(place.value > negligible); });
    known.insert(known.end(), found.begin(), found.end());
    looked_at = end;
    std::vector<WorstPlace> worst = worst_of(known, count, apart);
    const auto others_are_less = [&] { return count == 0 || worst.back().value > candidates[end].upper + negligible; };
    if (end == candidates.size() || (worst.size() == count && others_are_less())) return worst;
  }
}

}  // namespace orchard::detail
