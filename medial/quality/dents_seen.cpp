#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "boundary_reach.h"

namespace orchard::detail {
namespace {

constexpr std::size_t kBallBlock = 64;  // balls in one task
constexpr int kMaxWayOut = 50;          // steps on the way out of the reconstruction
constexpr double kOut = 1e-6;           // of the diagonal: a way out ends this near to the boundary

// Moves a place straight out of the nearest ball, then out of the next one, until no ball contains it. Returns false if
// that does not end.
bool go_out(const Reconstruction& reconstruction, Point& at, Sphere ball, double gap, double arrived) {
  for (int step = 0; step < kMaxWayOut; ++step) {
    const Vector way = at - ball.center;
    const double length = way.norm();
    if (!(length > 0)) return false;
    at = ball.center + ball.radius / length * way;
    if (gap > 0) return true;
    gap = reconstruction.distance_below(arrived, at, ball);
    if (gap > -arrived) return true;
  }
  return false;
}

}  // namespace

std::vector<Dent> dents_seen_from(std::span<const Sphere> balls, const Surface& surface,
                                  const Reconstruction& reconstruction, double min_depth) {
  const double arrived = kOut * (surface.bounding_box().max() - surface.bounding_box().min()).norm();
  std::vector<Dent> found(balls.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, balls.size(), kBallBlock), [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const auto& [center, radius] = balls[i];
      if (radius <= min_depth) continue;
      Sphere ball;
      const double gap =
          reconstruction.distance_between(min_depth - radius, std::numeric_limits<double>::infinity(), center, ball);
      Point place = center;
      if (gap < min_depth - radius || !go_out(reconstruction, place, ball, gap, arrived)) continue;
      ClosestPoint nearest;
      const double depth = -surface.signed_distance(place, nearest);
      if (depth > min_depth) found[i] = {place, depth, (nearest.position - place) / nearest.distance};
    }
  });
  std::erase_if(found, [](const Dent& dent) { return !(dent.depth > 0); });
  std::stable_sort(found.begin(), found.end(), [](const Dent& a, const Dent& b) { return a.depth > b.depth; });
  return found;
}

}  // namespace orchard::detail
