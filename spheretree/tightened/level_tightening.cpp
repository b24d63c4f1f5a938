#include "level_tightening.h"

#include "orchard/geometry/tolerance.h"

namespace orchard::detail {
namespace {

constexpr int kSampleEvaluations = 14, kSurfaceEvaluations = 10;

}  // namespace

std::vector<Point> ends_of(const std::vector<OpenArc>& arcs) {
  std::vector<Point> points;
  for (const OpenArc& arc : arcs) points.insert(points.end(), {arc.begin, arc.end});
  return points;
}

void tighten_to_samples(const Surface& surface, LevelBalls& balls) {
  BallFitter fitter(surface);
  std::vector<Point> points;
  for (Index b : balls.loosest_first()) {
    points.clear();
    balls.append_held_alone(b, points);
    if (points.empty()) continue;
    const FittedBall fitted = fitter.fit(points, balls[b], kSampleEvaluations);
    if (fitted.looseness() < balls[b].looseness()) balls.replace(b, fitted);
  }
}

void tighten_to_surface(const Surface& surface, LevelBalls& balls, LevelCover& cover) {
  const double margin = tolerance::kCoverMargin * surface.bounding_radius();
  BallFitter fitter(surface);
  LevelCover::Scratch scratch;
  std::vector<Index> near;
  std::vector<OpenArc> arcs;
  for (Index b : balls.loosest_first()) {
    const PlacedBall old = cover.balls()[b];
    arcs.clear();
    cover.triangles_near(old.sphere, near);
    cover.open_arcs(near, old.sphere, {{&b, 1}, {}}, scratch, arcs);
    if (arcs.empty()) continue;
    FittedBall fitted = fitter.fit(ends_of(arcs), balls[b], kSurfaceEvaluations);
    fitted.radius += margin;
    if (fitted.looseness() > balls[b].looseness() * (1 - kWorthwhileTightening)) continue;
    const PlacedBall fresh{{fitted.center, fitted.radius}, old.path_region};
    if (!cover.covered(scratch.open, old.sphere, {{&b, 1}, {&fresh, 1}}, scratch)) continue;
    cover.replace(b, fresh);
    balls.replace(b, fitted);
  }
}

}  // namespace orchard::detail
