#include "two_sided.h"

#include <algorithm>
#include <vector>

#include "../quality/boundary_reach.h"
#include "../quality/quality_parts.h"
#include "fit_samples.h"
#include "foot.h"

namespace orchard::detail {
namespace {

constexpr double kOfError = 0.02;  // of the requested error: how precisely values below it are searched
constexpr double kBallAccuracy = 1e-5, kHollowAccuracy = 1e-4;  // accuracies of the maxima, in diagonals

Spread spread_among(std::span<const SurfaceReach> reaches, double SurfaceReach::*value) {
  std::vector<double> values;
  values.reserve(reaches.size());
  for (const SurfaceReach& reach : reaches) values.push_back(reach.*value);
  return spread_of(values);
}

// Returns the largest protrusion of the balls, but at least `known`.
double max_protrusion_at(const Surface& surface, const QualityBalls& balls, double known) {
  for (const Sphere& ball : balls.all) {
    const BallDepth depth = depth_of(surface, ball);
    if (depth.signed_distance + ball.radius > known) known = std::max(known, reach_of(surface, ball, depth).beyond);
  }
  return known;
}

// The values from which on maxima are searched. If an error was requested, smaller values are not searched: proving
// that a maximum is below the error is fast, but computing by how much takes long.
class Searched {
 public:
  Searched(const SimplifyOptions& options, double diagonal)
      : diagonal_(diagonal), error_(options.vertices == 0 ? options.error * diagonal : 0) {}
  double above(double found) const { return std::max(found, (1 - 2 * kOfError) * error_); }
  double accuracy(double share) const {
    return error_ > 0 ? std::min(share * diagonal_, kOfError * error_) : share * diagonal_;
  }

 private:
  double diagonal_, error_;
};

}  // namespace

void measure_two_sided(const Surface& surface, const MedialMesh& mesh, std::span<const Sphere> inscribed,
                       const SimplifyOptions& options, SimplifyReport& report) {
  std::vector<SurfaceSample> samples;
  for (const FitSample& sample : fit_samples(surface, options.check, options.seed + 1))
    samples.push_back({sample.position, sample.normal});
  const double diagonal = surface.bounding_box().diagonal().norm();
  const Reconstruction reconstruction(mesh);
  const std::vector<SurfaceReach> reaches = reach_of(surface, reconstruction, samples, diagonal);
  const Spread uncovered = spread_among(reaches, &SurfaceReach::uncovered);
  const Spread to = spread_among(reaches, &SurfaceReach::to_boundary);
  const Spread from = spread_among(reaches, &SurfaceReach::from_boundary);
  const MaxOverTriangles open =
      max_coverage(surface, reconstruction, {.max = uncovered.max, .upper = 0, .place = Point::Zero()}, diagonal);
  Spread beyond = spread_among(reaches, &SurfaceReach::beyond);
  beyond.max = max_protrusion_at(surface, quality_balls(mesh, QualityOptions{}.cells), beyond.max);
  double max = std::max({to.max, from.max, beyond.max, open.upper});
  // The searches take most of the time, so they look only for values above those that are known.
  const std::vector<Dent> dents =
      dents_seen_from(balls_beyond(ContractibleMesh(mesh), inscribed, max), surface, reconstruction, max);
  if (!dents.empty()) max = dents.front().depth;
  const Searched searched(options, diagonal);
  const SearchedMax ball =
      max_protrusion(surface, mesh, {}, searched.above(max), searched.accuracy(kBallAccuracy), options.search);
  if (ball.max > searched.above(max)) max = beyond.max = ball.max;
  const SearchedMax dent =
      max_dent(surface, reconstruction, searched.above(max), searched.accuracy(kHollowAccuracy), options.search);
  if (dent.max > searched.above(max)) max = dent.max;
  report.coverage = {open.upper / diagonal, uncovered.mean / diagonal};
  report.protrusion = {beyond.max / diagonal, beyond.mean / diagonal};
  report.upper = std::max({max, open.upper, ball.upper, dent.upper}) / diagonal;
  report.hausdorff = {max / diagonal, 0.5 * (to.mean + from.mean) / diagonal};
}

}  // namespace orchard::detail
