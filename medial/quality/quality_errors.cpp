#include <tbb/parallel_for.h>

#include <cmath>

#include "orchard/geometry/error.h"
#include "quality_parts.h"

namespace orchard {

BallErrors ball_errors(const Surface& surface, std::span<const Sphere> balls, const QualityOptions& options) {
  if (!surface.solid())
    throw InputError(
        "balls are measured against a solid: the mesh must be closed and consistently oriented; repair it first");
  const double diagonal = surface.bounding_box().diagonal().norm();
  BallErrors errors;
  for (std::vector<double>* values : {&errors.radius_error, &errors.protrusion}) values->resize(balls.size());
  if (options.contact_cells > 0) errors.centredness.resize(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    const Sphere& ball = balls[i];
    const detail::BallDepth depth = detail::depth_of(surface, ball);
    errors.radius_error[i] = std::abs(ball.radius - depth.nearest.distance) / diagonal;
    errors.protrusion[i] = detail::reach_of(surface, ball, depth).beyond / diagonal;
    if (options.contact_cells > 0)
      errors.centredness[i] = detail::off_centre(surface, ball, depth.nearest, options.min_contact_angle, diagonal);
  });
  return errors;
}

std::vector<double> ball_protrusions(const Surface& surface, std::span<const Sphere> balls) {
  if (!surface.solid())
    throw InputError(
        "balls are measured against a solid: the mesh must be closed and consistently oriented; repair it first");
  const double diagonal = surface.bounding_box().diagonal().norm();
  std::vector<double> protrusions(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    protrusions[i] = detail::reach_of(surface, balls[i], detail::depth_of(surface, balls[i])).beyond / diagonal;
  });
  return protrusions;
}

SurfaceErrors surface_errors(const Surface& surface, const MedialMesh& mesh, std::span<const Point> points,
                             std::span<const Vector> normals) {
  if (!surface.solid())
    throw InputError(
        "a reconstruction is measured against a solid: the mesh must be closed and consistently oriented; repair it "
        "first");
  const double diagonal = surface.bounding_box().diagonal().norm();
  std::vector<detail::SurfaceSample> samples;
  samples.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) samples.push_back({points[i], normals[i]});
  SurfaceErrors errors;
  for (const detail::SurfaceReach& reach : detail::reach_of(surface, detail::Reconstruction(mesh), samples, diagonal)) {
    errors.coverage.push_back(reach.uncovered / diagonal);
    errors.protrusion.push_back(reach.beyond / diagonal);
  }
  return errors;
}

}  // namespace orchard
