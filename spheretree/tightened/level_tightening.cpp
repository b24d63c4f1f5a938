#include "level_tightening.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <optional>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr int kSampleEvaluations = 14, kSurfaceEvaluations = 10;

// The memory of a thread, kept from one ball to the next to avoid allocations.
struct Worker {
  Worker(const Surface& surface, BallMeasure measure) : fitter(surface, measure) {}
  BallFitter fitter;
  LevelCover::Scratch scratch;
  std::vector<Index> near;
  std::vector<OpenArc> arcs;
};

// Returns the ball fitted to the part of the surface that only it covers; nullopt if that is not worthwhile or would
// uncover something.
std::optional<FittedBall> tighter_on_surface(const Surface& surface, const LevelBall& ball, const LevelCover& cover,
                                             Index number, Worker& worker) {
  const PlacedBall old = cover.balls()[number];
  const std::span<const Index> gone(&number, 1);
  LevelCover::Scratch& scratch = worker.scratch;
  worker.arcs.clear();
  cover.triangles_near(number, worker.near);
  cover.open_arcs(worker.near, old.sphere, {gone, {}}, scratch, worker.arcs);
  if (worker.arcs.empty()) return {};
  FittedBall fitted = worker.fitter.fit(ends_of(worker.arcs), ball, kSurfaceEvaluations);
  fitted.radius += tolerance::kCoverMargin * surface.bounding_radius();
  if (fitted.looseness() > ball.looseness() * (1 - kWorthwhileTightening)) return {};
  const PlacedBall fresh{{fitted.center, fitted.radius}, old.path_region};
  if (!cover.covered(scratch.open, old.sphere, {gone, {&fresh, 1}}, scratch)) return {};
  return fitted;
}

}  // namespace

std::vector<Point> ends_of(const std::vector<OpenArc>& arcs) {
  std::vector<Point> points;
  points.reserve(2 * arcs.size());
  for (const OpenArc& arc : arcs) points.insert(points.end(), {arc.begin, arc.end});
  return points;
}

// Balls that are apart have no sample in common, so they can be fitted at the same time.
void tighten_to_samples(const Surface& surface, LevelBalls& balls) {
  struct Fit {
    std::optional<LevelBall> tighter;
    std::uint64_t samples = 0;
  };
  tbb::enumerable_thread_specific<BallFitter> fitters([&] { return BallFitter(surface, balls.measure()); });
  std::vector<Index> order = balls.loosest_first();
  while (!order.empty()) {
    const std::vector<Index> batch = balls.take_apart(order);
    std::vector<Fit> fits(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      const LevelBall& ball = balls[batch[i]];
      std::vector<Point> points;
      fits[i].samples = balls.append_held_alone(batch[i], points);
      if (points.empty() || fits[i].samples == ball.fitted_to) return;
      const FittedBall fitted = fitters.local().fit(points, ball, kSampleEvaluations);
      if (fitted.looseness() < ball.looseness()) fits[i].tighter = balls.fitted(batch[i], fitted);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (fits[i].tighter) balls.replace(batch[i], std::move(*fits[i].tighter));
      balls.set_fitted_to(batch[i], fits[i].samples);
    }
  }
}

void tighten_to_surface(const Surface& surface, LevelBalls& balls, LevelCover& cover) {
  tbb::enumerable_thread_specific<Worker> workers([&] { return Worker(surface, balls.measure()); });
  std::vector<Index> order = balls.loosest_first();
  while (!order.empty()) {
    const std::vector<Index> batch = balls.take_apart(order);
    std::vector<std::optional<LevelBall>> tighter(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      const auto fitted = tighter_on_surface(surface, balls[batch[i]], cover, batch[i], workers.local());
      if (fitted) tighter[i] = balls.fitted(batch[i], *fitted);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!tighter[i]) continue;
      cover.replace(batch[i], {{tighter[i]->center, tighter[i]->radius}, balls[batch[i]].path_region});
      balls.replace(batch[i], std::move(*tighter[i]));
    }
  }
}

}  // namespace orchard::detail
