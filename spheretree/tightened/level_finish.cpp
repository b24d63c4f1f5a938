#include "level_finish.h"

#include <algorithm>

#include "level_cover.h"
#include "orchard/covering/coverage.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/cover.h"
#include "uncovered_regions.h"

namespace orchard::detail {
namespace {

// Rounds of covering uncovered regions, after those that search and those that only tighten.
constexpr int kTakingRounds = 8;
// Over the last growth: gaps that remain to be closed by growing are at least this large.
constexpr double kFirstMargin = 0.5;
constexpr int kClosedRounds = 4;  // rounds of the search that never uncovers anything

class Finish {
 public:
  Finish(const Surface& surface, LevelSolver& solver, PartialTree& partial, const FinishOptions& options)
      : surface_(surface), solver_(solver), partial_(partial), options_(options), radius_(surface.bounding_radius()) {}

  // Finds uncovered regions and assigns them to balls, until only those are left that the last growth closes. In the
  // first rounds, places found in them are added to the samples, and the search goes on.
  void close_uncovered(TightenReport::Level& report) {
    Coverage coverage;
    std::vector<Sphere> changed_balls;
    const int rounds = options_.searching_rounds + options_.tightening_rounds + kTakingRounds;
    for (int round = 0; round < rounds; ++round) {
      report_progress(options_.progress, "tightening", 0.5 * round / rounds);
      take_balls();
      const std::vector<PathBall> balls = path_balls(partial_.tree());
      const std::vector<Index> triangles = round == 0 ? triangles_to_check(surface_, balls)
                                                      : triangles_to_recheck(surface_, coverage, changed_balls, balls);
      coverage = surface_coverage(surface_, triangles, balls);
      const std::vector<UncoveredRegion> uncovered = find_deep_uncovered_regions(surface_, coverage, balls);
      if (round == 0) report.uncovered_regions = static_cast<Index>(uncovered.size());
      if (uncovered.empty()) return;
      ++report.closing_rounds;
      const std::vector<LevelBall> before = solver_.balls();
      const bool search = round < options_.searching_rounds;
      solver_.close_regions(uncovered, !search);
      if (round < options_.searching_rounds + options_.tightening_rounds) solver_.tighten();
      if (search) {
        solver_.search(options_.search_trials);
        solver_.tighten();
      }
      changed_balls = changed(before);
    }
  }

  // Closes the rest by enlarging balls.
  void grow(TightenReport::Level& report) {
    take_balls();
    for (LevelNode& node : partial_.last()) node.sphere.radius += 0.5 * kLastGrowth * radius_;
    std::vector<std::vector<Index>> places;
    SphereTree closed = partial_.tree(places);
    const Index first = options_.keep_above ? static_cast<Index>(partial_.size() - 1) : 0;
    report.grown = cover(closed, surface_, {}, kFirstMargin * kLastGrowth, first).max_growth;
    partial_.take_spheres(closed, places);
  }

  // Now the surface is covered. Balls that were enlarged too much are fitted again without uncovering anything.
  void tighten_closed() {
    std::vector<std::vector<Index>> places;
    const SphereTree closed = partial_.tree(places);
    const auto level = static_cast<Index>(partial_.size() - 1);
    const auto first_below = std::find_if(closed.nodes.begin(), closed.nodes.end(),
                                          [&](const SphereNode& node) { return node.level == level; });
    std::vector<PathBall> upper = path_balls(closed);
    upper.resize(static_cast<std::size_t>(first_below - closed.nodes.begin()));
    std::vector<Index> path_ends;
    for (Index parent : partial_.parents()) {
      const Index place = places[level - 1][parent];
      path_ends.push_back(place);
      if (place != kNone) upper[place].leaf = false;
    }
    std::vector<PlacedBall> balls;
    for (std::size_t b = 0; b < solver_.balls().size(); ++b)
      balls.push_back({partial_.last()[b].sphere, solver_.balls()[b].path_region});
    LevelCover cover(surface_, upper, std::move(path_ends), std::move(balls));
    solver_.take_radii(cover);
    for (int k = 0; k < options_.tightenings; ++k) solver_.tighten(cover);
    for (int round = 0; round < kClosedRounds && options_.closed_trials > 0; ++round) {
      report_progress(options_.progress, "tightening", 0.5 + 0.5 * round / kClosedRounds);
      solver_.search(cover, options_.closed_trials / kClosedRounds);
      solver_.tighten(cover);
    }
    for (std::size_t b = 0; b < cover.balls().size(); ++b)
      partial_.last()[b] = {cover.balls()[b].sphere, partial_.parents()[cover.balls()[b].path_region]};
  }

 private:
  void take_balls() {
    Level& level = partial_.last();
    level.clear();
    for (const LevelBall& ball : solver_.balls())
      level.push_back(
          {{ball.center, ball.radius + tolerance::kCoverMargin * radius_}, partial_.parents()[ball.path_region]});
  }

  // Returns the balls that may have uncovered something, as they were before.
  std::vector<Sphere> changed(const std::vector<LevelBall>& before) const {
    const std::vector<LevelBall>& after = solver_.balls();
    std::vector<Sphere> changed;
    for (std::size_t b = 0; b < before.size(); ++b) {
      const bool holds_as_much = before[b].center == after[b].center && before[b].radius <= after[b].radius &&
                                 before[b].path_region == after[b].path_region;
      if (!holds_as_much) changed.push_back({before[b].center, before[b].radius + tolerance::kCoverMargin * radius_});
    }
    return changed;
  }

  const Surface& surface_;
  LevelSolver& solver_;
  PartialTree& partial_;
  const FinishOptions& options_;
  const double radius_;
};

}  // namespace

void finish_level(const Surface& surface, LevelSolver& solver, PartialTree& partial, const FinishOptions& options,
                  TightenReport::Level& report) {
  Finish finish(surface, solver, partial, options);
  finish.close_uncovered(report);
  finish.grow(report);
  finish.tighten_closed();
  for (LevelNode& node : partial.last()) node.sphere.radius += 0.5 * kLastGrowth * surface.bounding_radius();
}

}  // namespace orchard::detail
