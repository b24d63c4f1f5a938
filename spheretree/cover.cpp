#include "orchard/spheretree/cover.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "infinity.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "uncovered_regions.h"

namespace orchard {
namespace {

constexpr int kMaxCoverRounds = 60;
constexpr double kMarginGrowth = 2;  // factor from one round to the next
constexpr int kKeepingRounds = 30;   // the number of rounds in which balls that should not grow do not
using detail::kInfinity;

// Points of an uncovered region that one path should contain. The path region then contains their convex hull as well.
using Points = std::vector<Point>;

// Finds the path that contains given points at the smallest growth. Growth is measured relative to each ball's radius:
// one per cent of a large ball near the root adds as much looseness to its level as one per cent of a leaf adds to its
// own.
class PathGrower {
 public:
  // Balls of levels above `first_level` do not grow.
  PathGrower(SphereTree& tree, double margin, Index first_level)
      : tree_(tree), margin_(margin), first_level_(first_level) {}

  // Returns the cost of the cheapest path, and stores the first path with that cost. A greedy descent gives an upper
  // bound, which excludes most other paths. Returns infinity if no path can contain the points.
  double cost_of_best_path(const Points& points) {
    best_cost_ = std::nextafter(cost_of_greedy_path(points), kInfinity);
    best_leaf_ = kNone;
    descend(0, 0, points);
    return best_cost_;
  }

  // Enlarges the balls of the stored path until it contains the points. Returns the largest growth of a radius.
  double grow_best_path(const Points& points) {
    double max = 0;
    for (Index node = best_leaf_; node != kNone; node = tree_.nodes[node].parent) {
      if (tree_.nodes[node].level < first_level_) break;
      double& radius = tree_.nodes[node].sphere.radius;
      const double wanted = reach(node, points) + margin_;
      if (reach(node, points) <= radius - margin_ / 2) continue;
      max = std::max(max, wanted - radius);
      radius = std::max(radius, wanted);
    }
    return max;
  }

 private:
  double reach(Index node, const Points& points) const {
    double farthest = 0;
    const Point& center = tree_.nodes[node].sphere.center;
    for (const Point& point : points) farthest = std::max(farthest, (point - center).squaredNorm());
    return std::sqrt(farthest);
  }

  double cost_with(Index index, double cost_above, const Points& points) const {
    const double radius = tree_.nodes[index].sphere.radius;
    if (tree_.nodes[index].level < first_level_) return reach(index, points) > radius ? kInfinity : cost_above;
    return cost_above + std::max(0.0, reach(index, points) + margin_ - radius) / radius;
  }

  double cost_of_greedy_path(const Points& points) const {
    double cost = cost_with(0, 0, points);
    for (Index index = 0; tree_.nodes[index].child_count > 0;) {
      const SphereNode& node = tree_.nodes[index];
      double least = kInfinity;
      for (Index child = node.first_child; child < node.first_child + node.child_count; ++child) {
        const double with_child = cost_with(child, cost, points);
        if (with_child < least || child == node.first_child) least = with_child, index = child;
      }
      cost = least;
    }
    return cost;
  }

  void descend(Index index, double cost_above, const Points& points) {
    const SphereNode& node = tree_.nodes[index];
    const double cost = cost_with(index, cost_above, points);
    if (cost >= best_cost_) return;
    if (node.child_count == 0) {
      best_cost_ = cost;
      best_leaf_ = index;
      return;
    }
    for (Index child = node.first_child; child < node.first_child + node.child_count; ++child)
      descend(child, cost, points);
  }

  SphereTree& tree_;
  const double margin_;
  const Index first_level_;
  double best_cost_ = 0;
  Index best_leaf_ = kNone;
};

// Grows one path for the whole uncovered region, or one for each of its points, whichever grows less.
double grow_over(PathGrower& grower, const detail::UncoveredRegion& uncovered) {
  Points all = uncovered.corners;
  if (all.empty()) all.push_back(uncovered.farthest);
  const double together = grower.cost_of_best_path(all);
  if (together == 0) return 0;
  double apart = 0;
  for (const Point& point : all) apart = std::max(apart, grower.cost_of_best_path({point}));
  double max = 0;
  if (together <= 4 * apart && together < kInfinity) {
    grower.cost_of_best_path(all);
    return grower.grow_best_path(all);
  }
  for (const Point& point : all)
    if (const double cost = grower.cost_of_best_path({point}); cost > 0 && cost < kInfinity)
      max = std::max(max, grower.grow_best_path({point}));
  return max;
}

}  // namespace

CoverReport cover(SphereTree& tree, const Surface& surface, const Progress& progress, double first_margin,
                  Index first_level) {
  const double radius = surface.bounding_radius();
  CoverReport report;
  std::vector<Index> triangles;
  for (Index i = 0; i < surface.mesh().triangles.size(); ++i) triangles.push_back(i);
  double margin = first_margin * radius;
  for (; report.rounds < kMaxCoverRounds; ++report.rounds) {
    report_progress(progress, "covering", static_cast<double>(report.rounds) / kMaxCoverRounds);
    const Coverage coverage = surface_coverage(surface, triangles, path_balls(tree));
    if (coverage.complete()) return report;
    if (report.rounds == 0) report.triangles_uncovered = static_cast<Index>(coverage.uncovered.size());
    // Balls only grow, so what is covered stays covered.
    triangles.clear();
    PathGrower grower(tree, margin, report.rounds < kKeepingRounds ? first_level : 0);
    const auto take = [&](const detail::UncoveredRegion& region) {
      report.max_growth = std::max(report.max_growth, grow_over(grower, region) / radius);
    };
    for (const detail::UncoveredRegion& region :
         detail::find_uncovered_regions(surface, coverage, path_balls(tree), tolerance::kCoverMargin * radius))
      take(region);
    for (const UncoveredTriangle& uncovered : coverage.uncovered) {
      triangles.push_back(uncovered.triangle);
      for (const Point& corner : surface.corners(uncovered.triangle)) take({{}, corner, 0});
    }
    // Uncovered regions shrink with every round, and the margin is widened a little so that the rounds end.
    margin *= kMarginGrowth;
  }
  throw Error("cover: " + std::to_string(triangles.size()) + " triangles are still uncovered after " +
              std::to_string(kMaxCoverRounds) + " rounds");
}

namespace {

// Returns the leaf whose path needs to grow least to contain the point.
Index nearest_leaf(const SphereTree& tree, const Point& point) {
  Index best = kNone;
  double min = kInfinity;
  for (Index leaf = 0; leaf < tree.nodes.size(); ++leaf) {
    if (tree.nodes[leaf].child_count > 0) continue;
    double outside = 0;
    for (Index up = leaf; up != kNone; up = tree.nodes[up].parent)
      outside = std::max(outside, (point - tree.nodes[up].sphere.center).norm() - tree.nodes[up].sphere.radius);
    if (outside < min) min = outside, best = leaf;
  }
  return best;
}

}  // namespace

CoverReport grow_to_cover(SphereTree& tree, const Surface& surface, double factor, const Progress& progress) {
  if (!(factor > 1)) throw InputError("growth: the factor must be above 1");
  CoverReport report;
  std::vector<Index> triangles(surface.mesh().triangles.size());
  std::iota(triangles.begin(), triangles.end(), Index{0});
  for (; report.rounds < kMaxCoverRounds; ++report.rounds) {
    report_progress(progress, "growing", static_cast<double>(report.rounds) / kMaxCoverRounds);
    const Coverage coverage = surface_coverage(surface, triangles, path_balls(tree));
    if (coverage.complete()) return report;
    if (report.rounds == 0) report.triangles_uncovered = static_cast<Index>(coverage.uncovered.size());
    std::vector<char> grows(tree.nodes.size(), 0);
    triangles.clear();
    for (const UncoveredTriangle& uncovered : coverage.uncovered) {
      triangles.push_back(uncovered.triangle);
      for (const UncoveredArc& arc : uncovered.cover.arcs) grows[arc.ball] = 1;
      if (!uncovered.cover.arcs.empty()) continue;
      for (Index up = nearest_leaf(tree, uncovered.cover.witness); up != kNone; up = tree.nodes[up].parent)
        grows[up] = 1;
    }
    for (Index i = 0; i < tree.nodes.size(); ++i) {
      if (!grows[i]) continue;
      double& radius = tree.nodes[i].sphere.radius;
      report.max_growth = std::max(report.max_growth, (factor - 1) * radius / surface.bounding_radius());
      radius *= factor;
    }
  }
  throw Error("growing: " + std::to_string(triangles.size()) + " triangles are still uncovered after " +
              std::to_string(kMaxCoverRounds) + " rounds");
}

}  // namespace orchard
