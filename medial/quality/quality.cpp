#include "orchard/medial/quality.h"

#include <algorithm>
#include <cmath>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "quality_parts.h"

namespace orchard {
namespace detail {
namespace {

constexpr std::uint64_t kSampleStage = 0x717561;

// Visits `max` of `count` items (or all, if there are no more) at even steps.
template <class Visit>
void evenly(std::size_t count, Index max, const Visit& visit) {
  const std::size_t chosen = std::min<std::size_t>(count, max);
  for (std::size_t i = 0; i < chosen; ++i) visit(i * count / chosen);
}

}  // namespace

std::vector<SurfaceSample> quality_samples(const Surface& surface, Index count, std::uint64_t seed) {
  const Index triangles = static_cast<Index>(surface.mesh().triangles.size());
  std::vector<double> area(triangles);
  double whole = 0;
  for (Index t = 0; t < triangles; ++t) area[t] = whole += surface.area(t);
  std::vector<SurfaceSample> samples;
  for (Index i = 0; i < count; ++i) {
    Random random(seed, kSampleStage, i);
    const double place = whole * (i + random.uniform()) / count;
    const auto found = std::upper_bound(area.begin(), area.end() - 1, place);
    const Index t = static_cast<Index>(found - area.begin());
    const auto [a, b, c] = surface.corners(t);
    const double u = std::sqrt(random.uniform()), v = random.uniform();
    samples.push_back({(1 - u) * a + u * (1 - v) * b + u * v * c, surface.normal(t)});
  }
  return samples;
}

QualityBalls quality_balls(const MedialMesh& mesh, Index max) {
  QualityBalls balls;
  const auto add_middle = [&](const auto& corners) {
    Sphere ball;
    for (const Index corner : corners) ball.center += mesh.centers[corner], ball.radius += mesh.radii[corner];
    const double count = static_cast<double>(corners.size());
    balls.all.push_back({ball.center / count, ball.radius / count});
  };
  evenly(mesh.centers.size(), max, [&](std::size_t i) { balls.all.push_back({mesh.centers[i], mesh.radii[i]}); });
  balls.vertices = balls.all.size();
  evenly(mesh.edges.size(), max, [&](std::size_t i) { add_middle(mesh.edges[i]); });
  balls.edges = balls.all.size() - balls.vertices;
  evenly(mesh.triangles.size(), max, [&](std::size_t i) { add_middle(mesh.triangles[i]); });
  return balls;
}

Spread spread_of(std::span<const double> values) {
  Spread spread;
  for (const double value : values) {
    spread.max = std::max(spread.max, value);
    spread.mean += value;
  }
  if (!values.empty()) spread.mean /= static_cast<double>(values.size());
  return spread;
}

}  // namespace detail

MedialQuality medial_quality(const Surface& surface, const MedialMesh& mesh, const QualityOptions& options,
                             const Progress& progress) {
  validate(mesh);
  MedialQuality quality;
  quality.wanted = solid_topology(surface);
  quality.diagonal = surface.bounding_box().diagonal().norm();
  report_progress(progress, "quality: topology", 0);
  quality.found = topology(mesh);
  report_progress(progress, "quality: reconstruction", 0.2);
  const auto samples = detail::quality_samples(surface, options.surface_samples, options.seed);
  const detail::QualityBalls balls = detail::quality_balls(mesh, options.cells);
  const std::vector<detail::BallDepth> depths = detail::depths_of(surface, balls.all);
  detail::measure_reconstruction(surface, mesh, samples, balls, depths, options, quality);
  report_progress(progress, "quality: contacts", 0.5);
  detail::measure_contacts(surface, balls.at_vertices(), depths, options, quality);
  report_progress(progress, "quality: economy", 0.8);
  quality.economy = detail::measure_economy(surface, mesh, options, quality.diagonal);
  quality.balls = mesh.size();
  quality.border_length = border_length(mesh) / quality.diagonal;
  quality.pieces = medial_pieces(mesh);
  for (WorstPlace& place : quality.worst) place.value /= quality.diagonal;
  for (double* upper : {&quality.coverage_upper, &quality.protrusion_upper, &quality.dent_upper})
    *upper /= quality.diagonal;
  for (Spread* spread :
       {&quality.hausdorff, &quality.coverage, &quality.inner_coverage, &quality.protrusion, &quality.radius_error}) {
    spread->max /= quality.diagonal;
    spread->mean /= quality.diagonal;
  }
  report_progress(progress, "quality: economy", 1);
  return quality;
}

}  // namespace orchard
