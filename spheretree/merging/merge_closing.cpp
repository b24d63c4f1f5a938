#include "merge_closing.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "ball_fit.h"
#include "cover_candidates.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/cover.h"

namespace orchard::detail {
namespace {

constexpr int kMergeClosingRounds = 14;

class Closer {
 public:
  Closer(SphereTree& tree, const Surface& surface, std::vector<std::vector<Point>>& held, double power)
      : tree_(tree),
        surface_(surface),
        held_(held),
        power_(power),
        radius_(surface.bounding_radius()),
        margin_(tolerance::kCoverMargin * radius_),
        fitters_([&surface] { return BallFitter(surface); }) {
    center_distance_.resize(tree.nodes.size());
    tbb::parallel_for(std::size_t{0}, center_distance_.size(), [&](std::size_t i) {
      center_distance_[i] = surface_.signed_distance(tree_.nodes[i].sphere.center);
    });
  }

  ClosingReport run() {
    ClosingReport report;
    Coverage coverage;
    std::vector<Sphere> changed;
    for (; report.rounds < kMergeClosingRounds; ++report.rounds) {
      const std::vector<PathBall> balls = path_balls(tree_);
      const std::vector<Index> triangles = report.rounds == 0
                                               ? triangles_to_check(surface_, balls)
                                               : triangles_to_recheck(surface_, coverage, changed, balls);
      coverage = surface_coverage(surface_, triangles, balls);
      const std::vector<UncoveredRegion> uncovered = find_deep_uncovered_regions(surface_, coverage, balls);
      if (report.rounds == 0) report.uncovered_regions = static_cast<Index>(uncovered.size());
      if (uncovered.empty()) break;
      const std::vector<Index> candidates = give(uncovered);
      changed.clear();
      for (Index node : candidates) changed.push_back(tree_.nodes[node].sphere);
      tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) { refit(candidates[i]); });
    }
    const Index last = tree_.depth();
    for (SphereNode& node : tree_.nodes)
      if (node.level == last) node.sphere.radius += kLastGrowth * radius_;
    report.growth = cover(tree_, surface_).max_growth;
    return report;
  }

 private:
  // Assigns each uncovered region to the node that covers it at the lowest cost. Returns these nodes, ascending.
  std::vector<Index> give(const std::vector<UncoveredRegion>& uncovered) {
    const std::vector<Taking> takings = find_cover_candidates(uncovered, [&](const UncoveredRegion& region) {
      CoverCandidates best;
      descend(0, {&region.farthest, 1}, best.farthest);
      if (best.farthest.ball != kNone) descend(0, region.points(), best.whole);
      return best;
    });
    std::vector<char> marked(tree_.nodes.size(), 0);
    for (std::size_t i = 0; i < uncovered.size(); ++i) {
      const std::vector<Point>& corners = uncovered[i].corners;
      const auto [candidate, whole] = takings[i];
      if (candidate == kNone) continue;  // the region crosses the border of a path region, so cover() closes it later
      marked[candidate] = 1;
      held_[candidate].push_back(uncovered[i].farthest);
      if (whole) held_[candidate].insert(held_[candidate].end(), corners.begin(), corners.end());
    }
    std::vector<Index> candidates;
    for (Index i = 0; i < marked.size(); ++i)
      if (marked[i]) candidates.push_back(i);
    return candidates;
  }

  void refit(Index i) {
    const FittedBall fitted = fitters_.local().fit(held_[i], tree_.nodes[i].sphere.center, kCandidateEvaluations);
    tree_.nodes[i].sphere = {fitted.center, fitted.radius + margin_};
    center_distance_[i] = fitted.center_distance;
  }

  // Finds the cheapest of the leaves below the node whose path region, without the leaf itself, contains the points.
  void descend(Index index, std::span<const Point> points, CoverCandidate& best) const {
    const SphereNode& node = tree_.nodes[index];
    double reach = 0;
    for (const Point& p : points) reach = std::max(reach, (p - node.sphere.center).squaredNorm());
    if (node.child_count > 0) {
      if (reach > node.sphere.radius * node.sphere.radius) return;
      for (Index k = 0; k < node.child_count; ++k) descend(node.first_child + k, points, best);
      return;
    }
    const double growth = std::max(0.0, std::sqrt(reach) - node.sphere.radius) / radius_;
    const double loose = std::max(0.0, node.sphere.radius + center_distance_[index]) / radius_;
    const double rise = std::pow(loose + growth, power_) - std::pow(loose, power_) + kCandidateTie * growth;
    if (rise < best.rise) best = {index, rise};
  }

  SphereTree& tree_;
  const Surface& surface_;
  std::vector<std::vector<Point>>& held_;
  const double power_, radius_, margin_;
  std::vector<double> center_distance_;  // signed distances of the balls' centres
  tbb::enumerable_thread_specific<BallFitter> fitters_;
};

}  // namespace

ClosingReport close_by_refitting(SphereTree& tree, const Surface& surface, std::vector<std::vector<Point>>& held,
                                 double power) {
  return Closer(tree, surface, held, power).run();
}

}  // namespace orchard::detail
