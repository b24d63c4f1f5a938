#include "level_solver.h"

#include "level_start.h"
#include "level_tightening.h"

namespace orchard::detail {
namespace {

LevelBalls started(const Surface& surface, PathRegions regions, const LevelOptions& options,
                   std::vector<LevelBall> start) {
  std::vector<LevelBall> balls = start.empty() ? seeded_balls(surface, regions, options)
                                               : relaxed_balls(surface, regions, options, std::move(start));
  return {std::move(regions), std::move(balls), options.max_children, options.measure};
}

}  // namespace

LevelSolver::LevelSolver(const Surface& surface, const Samples& samples, std::vector<std::vector<Sphere>> paths,
                         const LevelOptions& options, std::vector<LevelBall> start)
    : surface_(surface),
      balls_(started(surface, PathRegions(samples, std::move(paths)), options, std::move(start))),
      objective_(options.cost, balls_.all(), surface.bounding_radius()),
      search_(surface, objective_, options.measure, options.seed, options.level) {}

void LevelSolver::search(Index trials, const Progress& progress) { search_.run(balls_, trials, progress); }

void LevelSolver::tighten() { tighten_to_samples(surface_, balls_); }

void LevelSolver::close_regions(const std::vector<UncoveredRegion>& uncovered, bool hold) {
  detail::close_regions(surface_, objective_, uncovered, hold, balls_);
}

void LevelSolver::take_radii(const LevelCover& cover) {
  std::vector<double> radii;
  for (const PlacedBall& ball : cover.balls()) radii.push_back(ball.sphere.radius);
  balls_.set_radii(radii);
}

void LevelSolver::tighten(LevelCover& cover) { tighten_to_surface(surface_, balls_, cover); }

void LevelSolver::search(LevelCover& cover, Index trials) { search_.run_covering(balls_, trials, cover); }

}  // namespace orchard::detail
