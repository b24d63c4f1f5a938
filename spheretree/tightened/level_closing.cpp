#include "level_closing.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "cover_candidates.h"

namespace orchard::detail {
namespace {

// How far from an uncovered region's corner towards its farthest point a held point is placed. The corners themselves
// lie on other balls, so a ball that took them would soon give them back.
constexpr double kInward = 0.1;

// Finds the balls for which an uncovered region costs least. Only balls in the few path regions that hold its points
// are candidates. The objective is convex in the looseness, so its rise is at least the slope times the growth: by this
// bound most candidates are skipped.
class CandidateSearch {
 public:
  CandidateSearch(const LevelBalls& balls, const LevelObjective& objective, double bounding_radius)
      : balls_(balls), objective_(objective), bounding_radius_(bounding_radius), balls_in_(balls.regions().size()) {
    for (Index b = 0; b < balls.size(); ++b) {
      slopes_.push_back(objective.slope(balls[b]));
      balls_in_[balls[b].path_region].push_back(b);
    }
  }

  CoverCandidates cheapest(const UncoveredRegion& uncovered) const {
    CoverCandidates best;
    std::vector<Index> path_regions = balls_.regions().regions_around(uncovered.farthest);
    best.farthest = cheapest({&uncovered.farthest, 1}, path_regions);
    std::erase_if(path_regions, [&](Index r) {
      return !std::all_of(uncovered.corners.begin(), uncovered.corners.end(),
                          [&](const Point& p) { return balls_.regions().holds(r, p); });
    });
    if (!path_regions.empty()) best.whole = cheapest(uncovered.points(), path_regions);
    return best;
  }

 private:
  struct Candidate {
    double min_rise;
    Index ball;
  };

  // The cheapest ball in these path regions; of equals, the first. The search begins with the ball that the last point,
  // which is the region's farthest, suggests.
  CoverCandidate cheapest(std::span<const Point> points, std::span<const Index> path_regions) const {
    std::vector<Candidate> candidates;
    for (Index r : path_regions)
      for (Index b : balls_in_[r])
        candidates.push_back({slopes_[b] * ((points.back() - balls_[b].center).norm() - balls_[b].radius), b});
    CoverCandidate best;
    if (candidates.empty()) return best;
    std::iter_swap(candidates.begin(),
                   std::min_element(candidates.begin(), candidates.end(),
                                    [](auto& one, auto& other) { return one.min_rise < other.min_rise; }));
    for (const auto& [min_rise, b] : candidates)
      if (!surely_above(min_rise, best)) consider(b, points, best);
    return best;
  }

  static bool surely_above(double min_rise, const CoverCandidate& best) { return min_rise > best.rise * (1 + 1e-3); }

  void consider(Index b, std::span<const Point> points, CoverCandidate& best) const {
    const LevelBall& ball = balls_[b];
    FittedBall grown = ball;
    const auto too_dear = [&](const Point& p) {
      grown.radius = std::max(grown.radius, (p - ball.center).norm());
      return surely_above(slopes_[b] * (grown.radius - ball.radius), best);
    };
    if (std::any_of(points.begin(), points.end(), too_dear)) return;
    const double growth = grown.radius - ball.radius;
    const double rise =
        (growth > 0 ? objective_.cost(grown) - objective_.cost(ball) : 0) + kCandidateTie * growth / bounding_radius_;
    if (rise < best.rise || (rise == best.rise && b < best.ball)) best = {b, rise};
  }

  const LevelBalls& balls_;
  const LevelObjective& objective_;
  double bounding_radius_;
  std::vector<double> slopes_;                // derivative of each ball's cost by its radius
  std::vector<std::vector<Index>> balls_in_;  // balls in each path region, ascending
};

// Fits each ball again, to what it was given and to the samples that no other ball holds. Balls that are apart share no
// sample.
void fit_again(const Surface& surface, std::vector<std::vector<Point>>& taken, LevelBalls& balls) {
  std::vector<Index> order;
  for (Index b = 0; b < balls.size(); ++b)
    if (!taken[b].empty()) order.push_back(b);
  while (!order.empty()) {
    const std::vector<Index> batch = balls.take_apart(order);
    std::vector<LevelBall> fitted(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      std::vector<Point>& points = taken[batch[i]];
      balls.append_held_alone(batch[i], points);
      fitted[i] = balls.fitted(
          batch[i], BallFitter(surface, balls.measure()).fit(points, balls[batch[i]], kCandidateEvaluations));
    });
    for (std::size_t i = 0; i < batch.size(); ++i) balls.replace(batch[i], std::move(fitted[i]));
  }
}

}  // namespace

void close_regions(const Surface& surface, const LevelObjective& objective,
                   const std::vector<UncoveredRegion>& uncovered, bool hold, LevelBalls& balls) {
  const CandidateSearch search(balls, objective, surface.bounding_radius());
  const std::vector<Taking> takings =
      find_cover_candidates(uncovered, [&](const UncoveredRegion& region) { return search.cheapest(region); });
  std::vector<std::vector<Point>> taken(balls.size());
  Samples fresh;
  const auto add_sample = [&](const Point& point, Index ball) {
    fresh.points.push_back(point);
    fresh.starts.push_back(balls[ball].center);
  };
  for (std::size_t i = 0; i < uncovered.size(); ++i) {
    const UncoveredRegion& region = uncovered[i];
    const auto [candidate, whole] = takings[i];
    if (candidate == kNone) continue;
    if (whole) taken[candidate].insert(taken[candidate].end(), region.corners.begin(), region.corners.end());
    taken[candidate].push_back(region.farthest);
    add_sample(region.farthest, candidate);
    if (!hold || !whole) continue;
    for (const Point& p : region.corners) add_sample((1 - kInward) * p + kInward * region.farthest, candidate);
  }
  balls.add_samples(fresh);
  fit_again(surface, taken, balls);
}

}  // namespace orchard::detail
