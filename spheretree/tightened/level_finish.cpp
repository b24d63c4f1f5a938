#include "level_finish.h"

#include <algorithm>
#include <numeric>

#include "level_cover.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/cover.h"
#include "uncovered_regions.h"

namespace orchard::detail {
namespace {

// Gaps below this part of the last growth are left to it.
constexpr double kSmallGap = 0.4;
constexpr int kTighteningRounds = 4;  // after those that search
constexpr int kTakingRounds = 8;      // after these
constexpr int kClosedRounds = 4;      // of the search that never uncovers anything

class Closing {
 public:
  Closing(const Surface& surface, LevelSolver& solver, PartialTree& stack, const ClosingOptions& options)
      : surface_(surface), solver_(solver), stack_(stack), options_(options), radius_(surface.bounding_radius()) {}

  // Finds what no path region is certain to hold and has the balls take it in, until only gaps are left that the last
  // growth fills. While there is work left, the search goes on with what was found among its samples.
  void take_in_gaps(TightenReport::Level& report) {
    std::vector<Index> triangles(surface_.mesh().triangles.size());
    std::iota(triangles.begin(), triangles.end(), Index{0});
    const int rounds = options_.polishing + kTighteningRounds + kTakingRounds;
    for (int round = 0; round < rounds; ++round) {
      report_progress(options_.progress, "tightening", 0.5 * round / rounds);
      take_balls();
      const std::vector<PathBall> balls = path_balls(stack_.tree());
      const Coverage coverage = surface_coverage(surface_, triangles, balls);
      const auto regions = large_regions(coverage, balls);
      if (round == 0) report.gaps = static_cast<Index>(regions.size());
      if (regions.empty()) return;
      ++report.closing_rounds;
      const std::vector<LevelBall> before = solver_.balls();
      const bool polish = round < options_.polishing;
      solver_.take_in(regions, !polish);
      if (round < options_.polishing + kTighteningRounds) solver_.tighten();
      if (polish) {
        solver_.search(options_.search_trials);
        solver_.tighten();
      }
      triangles = to_recheck(coverage, before);
    }
  }

  // Settles what is left by growing.
  void grow(TightenReport::Level& report) {
    take_balls();
    for (LevelNode& node : stack_.last()) node.sphere.radius += 0.5 * kLastGrowth * radius_;
    std::vector<std::vector<Index>> places;
    SphereTree closed = stack_.tree(places);
    report.grown = cover(closed, surface_, {}).max_growth;
    stack_.take_spheres(closed, places);
  }

  // The surface is covered: what was grown carelessly is fitted again, with nothing uncovered.
  void tighten_closed() {
    std::vector<std::vector<Index>> places;
    const SphereTree closed = stack_.tree(places);
    const auto level = static_cast<Index>(stack_.size() - 1);
    const auto first_below = std::find_if(closed.nodes.begin(), closed.nodes.end(),
                                          [&](const SphereNode& node) { return node.level == level; });
    std::vector<PathBall> upper = path_balls(closed);
    upper.resize(static_cast<std::size_t>(first_below - closed.nodes.begin()));
    std::vector<Index> region_nodes;
    for (Index parent : stack_.parents()) {
      const Index place = places[level - 1][parent];
      region_nodes.push_back(place);
      if (place != kNone) upper[place].leaf = false;
    }
    std::vector<RegionBall> balls;
    for (std::size_t b = 0; b < solver_.balls().size(); ++b)
      balls.push_back({stack_.last()[b].sphere, solver_.balls()[b].region});
    LevelCover cover(surface_, upper, std::move(region_nodes), std::move(balls));
    solver_.take_radii(cover);
    solver_.refit(cover);
    for (int round = 0; round < kClosedRounds && options_.closed_trials > 0; ++round) {
      report_progress(options_.progress, "tightening", 0.5 + 0.5 * round / kClosedRounds);
      solver_.polish(cover, options_.closed_trials / kClosedRounds);
      solver_.refit(cover);
    }
    for (std::size_t b = 0; b < cover.balls().size(); ++b)
      stack_.last()[b] = {cover.balls()[b].sphere, stack_.parents()[cover.balls()[b].region]};
  }

 private:
  void take_balls() {
    Level& level = stack_.last();
    level.clear();
    for (const LevelBall& ball : solver_.balls())
      level.push_back({{ball.center, ball.radius + tolerance::kCoverMargin * radius_}, stack_.parents()[ball.region]});
  }

  std::vector<UncoveredRegion> large_regions(const Coverage& coverage, std::span<const PathBall> balls) const {
    auto regions = find_uncovered_regions(surface_, coverage, balls, tolerance::kCoverMargin * radius_);
    std::erase_if(regions,
                  [&](const UncoveredRegion& region) { return region.depth <= kSmallGap * kLastGrowth * radius_; });
    return regions;
  }

  // Uncovered triangles, and those that a ball may have let go.
  std::vector<Index> to_recheck(const Coverage& coverage, const std::vector<LevelBall>& before) const {
    const std::vector<LevelBall>& after = solver_.balls();
    std::vector<char> marked(surface_.mesh().triangles.size(), 0);
    for (const UncoveredTriangle& uncovered : coverage.uncovered) marked[uncovered.triangle] = 1;
    std::vector<Index> near;
    for (std::size_t b = 0; b < before.size(); ++b) {
      if (before[b].center == after[b].center && before[b].radius <= after[b].radius &&
          before[b].region == after[b].region)
        continue;
      surface_.triangles_near({before[b].center, before[b].radius + tolerance::kCoverMargin * radius_}, near);
      for (Index triangle : near) marked[triangle] = 1;
    }
    std::vector<Index> triangles;
    for (Index i = 0; i < marked.size(); ++i)
      if (marked[i]) triangles.push_back(i);
    return triangles;
  }

  const Surface& surface_;
  LevelSolver& solver_;
  PartialTree& stack_;
  const ClosingOptions& options_;
  const double radius_;
};

}  // namespace

void close_level(const Surface& surface, LevelSolver& solver, PartialTree& stack, const ClosingOptions& options,
                 TightenReport::Level& report) {
  Closing closing(surface, solver, stack, options);
  closing.take_in_gaps(report);
  closing.grow(report);
  closing.tighten_closed();
  for (LevelNode& node : stack.last()) node.sphere.radius += 0.5 * kLastGrowth * surface.bounding_radius();
}

}  // namespace orchard::detail
