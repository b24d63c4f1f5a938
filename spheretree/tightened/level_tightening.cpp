#include "level_tightening.h"

#include <tbb/parallel_for.h>

#include <optional>

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr int kSampleEvaluations = 14, kSurfaceEvaluations = 10;

// The ball fitted to the surface that it alone covers; nothing if that is not worth while, or would uncover any.
std::optional<FittedBall> tighter_on_surface(const Surface& surface, const LevelBall& ball, const LevelCover& cover,
                                             Index number) {
  const PlacedBall old = cover.balls()[number];
  const std::span<const Index> gone(&number, 1);
  LevelCover::Scratch scratch;
  std::vector<Index> near;
  std::vector<OpenArc> arcs;
  cover.triangles_near(old.sphere, near);
  cover.open_arcs(near, old.sphere, {gone, {}}, scratch, arcs);
  if (arcs.empty()) return {};
  FittedBall fitted = BallFitter(surface).fit(ends_of(arcs), ball, kSurfaceEvaluations);
  fitted.radius += tolerance::kCoverMargin * surface.bounding_radius();
  if (fitted.looseness() > ball.looseness() * (1 - kWorthwhileTightening)) return {};
  const PlacedBall fresh{{fitted.center, fitted.radius}, old.path_region};
  if (!cover.covered(scratch.open, old.sphere, {gone, {&fresh, 1}}, scratch)) return {};
  return fitted;
}

}  // namespace

std::vector<Point> ends_of(const std::vector<OpenArc>& arcs) {
  std::vector<Point> points;
  for (const OpenArc& arc : arcs) points.insert(points.end(), {arc.begin, arc.end});
  return points;
}

// Balls that are apart share no sample: what one of them lets go of is none of the others' business.
void tighten_to_samples(const Surface& surface, LevelBalls& balls) {
  struct Fit {
    FittedBall ball;
    std::uint64_t samples = 0;
  };
  std::vector<Index> order = balls.loosest_first();
  while (!order.empty()) {
    const std::vector<Index> batch = balls.take_apart(order);
    std::vector<Fit> fits(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      const LevelBall& ball = balls[batch[i]];
      std::vector<Point> points;
      fits[i] = {ball, balls.append_held_alone(batch[i], points)};
      if (points.empty() || fits[i].samples == ball.fitted_to) return;
      fits[i].ball = BallFitter(surface).fit(points, ball, kSampleEvaluations);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (fits[i].ball.looseness() < balls[batch[i]].looseness()) balls.replace(batch[i], fits[i].ball);
      balls.set_fitted_to(batch[i], fits[i].samples);
    }
  }
}

void tighten_to_surface(const Surface& surface, LevelBalls& balls, LevelCover& cover) {
  std::vector<Index> order = balls.loosest_first();
  while (!order.empty()) {
    const std::vector<Index> batch = balls.take_apart(order);
    std::vector<std::optional<FittedBall>> tighter(batch.size());
    tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
      tighter[i] = tighter_on_surface(surface, balls[batch[i]], cover, batch[i]);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (!tighter[i]) continue;
      cover.replace(batch[i], {{tighter[i]->center, tighter[i]->radius}, balls[batch[i]].path_region});
      balls.replace(batch[i], *tighter[i]);
    }
  }
}

}  // namespace orchard::detail
