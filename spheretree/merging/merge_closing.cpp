#include "merge_closing.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ball_fit.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/cover.h"
#include "uncovered_regions.h"

namespace orchard::detail {
namespace {

constexpr int kRounds = 14;
constexpr int kEvaluations = 14;
// What every ball of a closed level grows by, as a fraction of R: gaps smaller than a part of it need no more work.
constexpr double kGrowth = 2e-5, kSmallGap = 0.4;
// What breaks ties between balls that would not get looser, as a fraction of growth.
constexpr double kTie = 1e-9;
// A region is taken in whole unless that costs so many times what its deepest point does.
constexpr double kDearer = 8;

struct Taker {
  Index node = kNone;
  double rise = std::numeric_limits<double>::infinity();  // of its cost
};

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
    depth_.resize(tree.nodes.size());
    tbb::parallel_for(std::size_t{0}, depth_.size(),
                      [&](std::size_t i) { depth_[i] = surface_.signed_distance(tree_.nodes[i].sphere.center); });
  }

  ClosingReport run() {
    ClosingReport report;
    std::vector<Index> triangles(surface_.mesh().triangles.size());
    std::iota(triangles.begin(), triangles.end(), Index{0});
    for (; report.rounds < kRounds; ++report.rounds) {
      const std::vector<PathBall> balls = path_balls(tree_);
      const Coverage coverage = surface_coverage(surface_, triangles, balls);
      auto regions = find_uncovered_regions(surface_, coverage, balls, margin_);
      std::erase_if(regions,
                    [&](const UncoveredRegion& region) { return region.depth <= kSmallGap * kGrowth * radius_; });
      if (report.rounds == 0) report.regions = static_cast<Index>(regions.size());
      if (regions.empty()) break;
      triangles = take_in(regions, coverage);
    }
    const Index last = tree_.depth();
    for (SphereNode& node : tree_.nodes)
      if (node.level == last) node.sphere.radius += kGrowth * radius_;
    report.growth = cover(tree_, surface_).max_growth;
    return report;
  }

 private:
  // Gives the regions to balls and fits these; returns the triangles that may be uncovered now.
  std::vector<Index> take_in(const std::vector<UncoveredRegion>& regions, const Coverage& coverage) {
    std::vector<Taker> whole(regions.size()), deepest(regions.size());
    tbb::parallel_for(std::size_t{0}, regions.size(), [&](std::size_t i) {
      std::vector<Point> points = regions[i].corners;
      points.push_back(regions[i].deepest);
      descend(0, points, whole[i]);
      descend(0, {regions[i].deepest}, deepest[i]);
    });
    std::vector<char> marked(tree_.nodes.size(), 0);
    for (std::size_t i = 0; i < regions.size(); ++i) {
      const bool together = whole[i].rise <= kDearer * deepest[i].rise;
      const Index taker = together ? whole[i].node : deepest[i].node;
      if (taker == kNone) continue;  // across the border of a region: cover() mends it
      marked[taker] = 1;
      held_[taker].push_back(regions[i].deepest);
      if (together) held_[taker].insert(held_[taker].end(), regions[i].corners.begin(), regions[i].corners.end());
    }
    std::vector<char> recheck(surface_.mesh().triangles.size(), 0);
    for (const UncoveredTriangle& uncovered : coverage.uncovered) recheck[uncovered.triangle] = 1;
    std::vector<Index> near;
    for (Index i = 0; i < marked.size(); ++i) {
      if (!marked[i]) continue;
      surface_.triangles_near(tree_.nodes[i].sphere, near);
      for (Index triangle : near) recheck[triangle] = 1;
    }
    tbb::parallel_for(std::size_t{0}, marked.size(), [&](std::size_t i) {
      if (marked[i]) refit(static_cast<Index>(i));
    });
    std::vector<Index> triangles;
    for (Index i = 0; i < recheck.size(); ++i)
      if (recheck[i]) triangles.push_back(i);
    return triangles;
  }

  void refit(Index i) {
    const FittedBall fitted = fitters_.local().fit(held_[i], tree_.nodes[i].sphere.center, kEvaluations);
    tree_.nodes[i].sphere = {fitted.center, fitted.radius + margin_};
    depth_[i] = fitted.depth;
  }

  // The leaf of which the region lies in the path region above, and that it costs least.
  void descend(Index index, const std::vector<Point>& region, Taker& best) const {
    const SphereNode& node = tree_.nodes[index];
    double reach = 0;
    for (const Point& p : region) reach = std::max(reach, (p - node.sphere.center).squaredNorm());
    if (node.child_count > 0) {
      if (reach > node.sphere.radius * node.sphere.radius) return;
      for (Index k = 0; k < node.child_count; ++k) descend(node.first_child + k, region, best);
      return;
    }
    const double growth = std::max(0.0, std::sqrt(reach) - node.sphere.radius) / radius_;
    const double loose = std::max(0.0, node.sphere.radius + depth_[index]) / radius_;
    const double rise = std::pow(loose + growth, power_) - std::pow(loose, power_) + kTie * growth;
    if (rise < best.rise) best = {index, rise};
  }

  SphereTree& tree_;
  const Surface& surface_;
  std::vector<std::vector<Point>>& held_;
  const double power_, radius_, margin_;
  std::vector<double> depth_;  // signed distances of the centres
  tbb::enumerable_thread_specific<BallFitter> fitters_;
};

}  // namespace

ClosingReport close_level(SphereTree& tree, const Surface& surface, std::vector<std::vector<Point>>& held,
                          double power) {
  return Closer(tree, surface, held, power).run();
}

}  // namespace orchard::detail
