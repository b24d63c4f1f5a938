#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "quality_parts.h"
#include "reconstruction.h"

namespace orchard::detail {
namespace {

constexpr double kArrived = 1e-6;  // of the diagonal: a march ends this near to the boundary
constexpr int kMostSteps = 50;

// How far along a unit direction a point inside a ball is from leaving it.
double way_out(const Sphere& ball, const Point& from, const Vector& direction) {
  const Vector offset = from - ball.center;
  const double along = offset.dot(direction);
  return std::sqrt(std::max(0.0, along * along + ball.radius * ball.radius - offset.squaredNorm())) - along;
}

// How far outside the solid the reconstruction reaches beyond a point of the surface, which `ball` holds `depth` deep:
// outward along the normal, from ball to ball, until none holds the point.
double reach_beyond(const Surface& surface, const Reconstruction& reconstruction, const SurfaceSample& sample,
                    Sphere ball, double depth, double diagonal) {
  Point at = sample.position;
  for (int step = 0; step < kMostSteps && depth > kArrived * diagonal; ++step) {
    at += way_out(ball, at, sample.normal) * sample.normal;
    depth = -reconstruction.distance(at, ball);
  }
  return at == sample.position ? 0.0 : std::max(0.0, surface.signed_distance(at));
}

// The point of a ball beyond the ball's nearest surface point is the farthest outside wherever the surface is flat or
// convex there; it is a point of the ball in any case, so what it gives is attained.
double protrusion_of(const Surface& surface, const Sphere& ball, bool& outside) {
  ClosestPoint nearest;
  const double depth = surface.signed_distance(ball.center, nearest);
  outside = depth > 0;
  if (!(depth + ball.radius > 0)) return 0;  // distance is 1-Lipschitz: all of the ball is inside
  if (!(nearest.distance > 0)) return std::max(0.0, ball.radius);
  const Vector outward = (depth > 0 ? 1.0 : -1.0) / nearest.distance * (ball.center - nearest.position);
  return std::max(0.0, surface.signed_distance(ball.center + ball.radius * outward));
}

// Returns the fraction of centres outside.
double look_at(const Surface& surface, const std::vector<Sphere>& balls, double& max) {
  std::vector<double> protrusions(balls.size());
  std::vector<std::uint8_t> outside(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t i) {
    bool out = false;
    protrusions[i] = protrusion_of(surface, balls[i], out);
    outside[i] = out ? 1 : 0;
  });
  for (const double value : protrusions) max = std::max(max, value);
  const auto count = std::count(outside.begin(), outside.end(), std::uint8_t{1});
  return balls.empty() ? 0 : static_cast<double>(count) / static_cast<double>(balls.size());
}

}  // namespace

void measure_reconstruction(const Surface& surface, const MedialMesh& mesh, std::span<const SurfaceSample> samples,
                            const QualityBalls& balls, MedialQuality& quality) {
  const Reconstruction reconstruction(mesh);
  std::vector<double> uncovered(samples.size()), beyond(samples.size());
  tbb::parallel_for(std::size_t{0}, samples.size(), [&](std::size_t i) {
    Sphere ball;
    const double distance = reconstruction.distance(samples[i].position, ball);
    uncovered[i] = std::max(0.0, distance);
    beyond[i] = reach_beyond(surface, reconstruction, samples[i], ball, -distance, quality.diagonal);
  });
  quality.coverage = spread_of(uncovered);
  quality.protrusion = spread_of(beyond);
  quality.outside_vertices = look_at(surface, balls.vertices, quality.protrusion.max);
  quality.outside_edges = look_at(surface, balls.edges, quality.protrusion.max);
  quality.outside_triangles = look_at(surface, balls.triangles, quality.protrusion.max);
}

}  // namespace orchard::detail
