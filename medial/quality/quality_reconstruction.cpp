#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "boundary_reach.h"
#include "quality_parts.h"

namespace orchard::detail {
namespace {

constexpr double kAtBoundary = 1e-6;       // of the diagonal: a march ends at a place this near to the boundary
constexpr double kCenterOnSurface = 1e-9;  // of the diagonal: centres that are no farther outside are on the surface
constexpr int kMaxMarchSteps = 50;
constexpr std::size_t kSampleBlock = 64;                            // samples that one task handles in turn
constexpr double kProtrusionAccuracy = 1e-5, kDentAccuracy = 1e-4;  // diagonals: accuracies of the maxima

// The distance from a point inside a ball to the ball's border in a unit direction.
double way_out(const Sphere& ball, const Point& from, const Vector& direction) {
  const Vector offset = from - ball.center;
  const double along = offset.dot(direction);
  return std::sqrt(std::max(0.0, along * along + ball.radius * ball.radius - offset.squaredNorm())) - along;
}

// Moves from a point that `ball` holds `depth` deep straight out of the deepest ball, again and again, until no ball
// holds the place. Returns the distance of this place of the union's boundary from the point; infinity if none is
// reached. If one step is enough, it is the shortest way.
double straight_out(const Reconstruction& reconstruction, const Point& from, Sphere ball, double depth,
                    double diagonal) {
  Point at = from;
  for (int step = 0; step < kMaxMarchSteps && depth > kAtBoundary * diagonal; ++step) {
    const Vector way = at - ball.center;
    const double length = way.norm();
    if (!(length > 0)) break;
    at = ball.center + ball.radius / length * way;
    depth = -reconstruction.distance_below(-kAtBoundary * diagonal, at, ball);
  }
  return depth > kAtBoundary * diagonal ? std::numeric_limits<double>::infinity() : (at - from).norm();
}

// Whether the way found from a point to the boundary may be much longer than the shortest.
bool is_loose(const SurfaceReach& reach, double diagonal) {
  return reach.to_boundary > 1.1 * reach.min_to_boundary + kAtBoundary * diagonal;
}

// Shortens ways that may be too long: places of the boundary at which the ways of other samples ended may be nearer.
void tighten(std::span<const SurfaceSample> samples, std::vector<SurfaceReach>& reaches, double diagonal) {
  std::vector<std::size_t> loose;
  TriangleMesh places;
  for (std::size_t i = 0; i < reaches.size(); ++i) {
    if (is_loose(reaches[i], diagonal)) loose.push_back(i);
    if (!reaches[i].arrived) continue;
    const Index place = static_cast<Index>(places.vertices.size());
    places.vertices.push_back(reaches[i].farthest);
    places.triangles.push_back({place, place, place});
  }
  if (loose.empty() || places.vertices.empty()) return;
  const Surface boundary(std::move(places));
  tbb::parallel_for(std::size_t{0}, loose.size(), [&](std::size_t k) {
    SurfaceReach& reach = reaches[loose[k]];
    reach.to_boundary = std::min(reach.to_boundary, boundary.distance(samples[loose[k]].position));
  });
}

// Marches from a sample outward along its normal, from ball to ball, until none holds the place. `cell`: a cell that
// may be near the sample, or kNone; it becomes the nearest one.
SurfaceReach reach_at(const Surface& surface, const Reconstruction& reconstruction, const SurfaceSample& sample,
                      Index& cell, double diagonal) {
  SurfaceReach reach;
  Reconstruction::Nearest nearest;
  if (cell != kNone) nearest = reconstruction.nearest_in(cell, sample.position);
  nearest = reconstruction.nearest_from(nearest, sample.position, -std::numeric_limits<double>::infinity());
  cell = nearest.cell;
  reach.ball = nearest.ball;
  double depth = -nearest.distance;
  reach.distance = -depth;
  reach.farthest = sample.position;
  if (depth < 0) {
    reach.uncovered = reach.to_boundary = -depth;
    const Vector way = reach.ball.center - sample.position;
    // The ball may have radius 0 and lie at the sample.
    if (way.norm() > 0) reach.farthest -= depth / way.norm() * way;
    reach.from_boundary = surface.distance(reach.farthest);
    return reach;
  }
  const Sphere deepest = reach.ball;
  const double first_depth = depth;
  for (int step = 0; step < kMaxMarchSteps && depth > kAtBoundary * diagonal; ++step) {
    reach.farthest += way_out(reach.ball, reach.farthest, sample.normal) * sample.normal;
    depth = -reconstruction.distance_below(-kAtBoundary * diagonal, reach.farthest, reach.ball);
  }
  if (reach.farthest == sample.position) return reach;
  const double off = surface.signed_distance(reach.farthest);
  reach.beyond = std::max(0.0, off);
  reach.from_boundary = std::abs(off);
  reach.arrived = !(depth > kAtBoundary * diagonal);
  reach.to_boundary = (reach.farthest - sample.position).norm();
  reach.min_to_boundary = first_depth;
  // The way along the normal is the shortest, unless the ball does not belong to this place of the surface.
  if (is_loose(reach, diagonal)) {
    reach.to_boundary =
        std::min(reach.to_boundary, straight_out(reconstruction, sample.position, deepest, first_depth, diagonal));
  }
  return reach;
}

double fraction_outside(std::span<const BallDepth> depths, double negligible) {
  if (depths.empty()) return 0;
  const auto outside =
      std::count_if(depths.begin(), depths.end(), [&](const BallDepth& d) { return d.outside_by(negligible); });
  return static_cast<double>(outside) / static_cast<double>(depths.size());
}

Vector outward_at(const Surface& surface, const Point& position) {
  const ClosestPoint nearest = surface.closest(position);
  return surface.pseudonormal(nearest.triangle, nearest.feature);
}

// The spread of one of the samples' values.
Spread spread_over(std::span<const SurfaceReach> reaches, double SurfaceReach::*value) {
  std::vector<double> values;
  values.reserve(reaches.size());
  for (const SurfaceReach& reach : reaches) values.push_back(reach.*value);
  return spread_of(values);
}

}  // namespace

std::vector<SurfaceReach> reach_of(const Surface& surface, const Reconstruction& reconstruction,
                                   std::span<const SurfaceSample> samples, double diagonal) {
  std::vector<SurfaceReach> reaches(samples.size());
  const std::size_t blocks = (samples.size() + kSampleBlock - 1) / kSampleBlock;
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t end = std::min(samples.size(), (block + 1) * kSampleBlock);
    Index cell = kNone;
    for (std::size_t i = block * kSampleBlock; i < end; ++i)
      reaches[i] = reach_at(surface, reconstruction, samples[i], cell, diagonal);
  });
  tighten(samples, reaches, diagonal);
  return reaches;
}

void measure_reconstruction(const Surface& surface, const MedialMesh& mesh, std::span<const SurfaceSample> samples,
                            const QualityBalls& balls, std::span<const BallDepth> depths, const QualityOptions& options,
                            MedialQuality& quality) {
  const Reconstruction reconstruction(mesh);
  const std::vector<SurfaceReach> reaches = reach_of(surface, reconstruction, samples, quality.diagonal);
  quality.coverage = spread_over(reaches, &SurfaceReach::uncovered);
  quality.inner_coverage = inner_coverage(mesh, reaches, quality.diagonal);
  const MaxOverTriangles open = max_coverage(
      surface, reconstruction, {.max = quality.coverage.max, .upper = 0, .place = Point::Zero()}, quality.diagonal);
  quality.protrusion = spread_over(reaches, &SurfaceReach::beyond);
  const Spread to = spread_over(reaches, &SurfaceReach::to_boundary);
  const Spread from = spread_over(reaches, &SurfaceReach::from_boundary);

  const double negligible = kAtBoundary * quality.diagonal;
  std::vector<WorstPlace> protruding, uncovered;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const SurfaceReach& reach = reaches[i];
    if (reach.beyond > negligible)
      protruding.push_back({WorstKind::protrusion, reach.beyond, reach.farthest, Vector::Zero(), reach.ball});
    if (reach.uncovered > negligible)
      uncovered.push_back({WorstKind::coverage, reach.uncovered, samples[i].position, samples[i].normal, reach.ball});
  }
  if (open.max > std::max(negligible, quality.coverage.max)) {
    Sphere ball;
    reconstruction.distance(open.place, ball);
    uncovered.push_back({WorstKind::coverage, open.max, open.place, outward_at(surface, open.place), ball});
  }
  quality.coverage.max = open.max;
  quality.coverage_upper = open.upper;
  const double on_surface = kCenterOnSurface * quality.diagonal;
  quality.outside_vertices = fraction_outside(depths.first(balls.vertices), on_surface);
  quality.outside_edges = fraction_outside(depths.subspan(balls.vertices, balls.edges), on_surface);
  const std::span<const BallDepth> of_triangles = depths.subspan(balls.vertices + balls.edges);
  quality.outside_triangles = fraction_outside(of_triangles, on_surface);
  const double apart = options.places_apart * quality.diagonal;
  const auto worst_protruding = [&](Index count) {
    return worst_protrusions(surface, balls.all, depths, protruding, count, apart, negligible);
  };
  for (const WorstPlace& place : worst_protruding(1)) quality.protrusion.max = place.value;
  const SearchedMax beyond =
      max_protrusion(surface, mesh, {depths.first(balls.vertices), of_triangles}, quality.protrusion.max,
                     kProtrusionAccuracy * quality.diagonal, options.search);
  if (beyond.max > std::max(negligible, quality.protrusion.max)) {
    protruding.push_back({WorstKind::protrusion, beyond.max, beyond.place, Vector::Zero(), beyond.ball});
    quality.protrusion.max = beyond.max;
  }
  quality.protrusion_upper = beyond.upper;
  quality.hausdorff = {.max = std::max({to.max, from.max, quality.protrusion.max, open.max}),
                       .mean = 0.5 * (to.mean + from.mean)};
  // Samples tell how deep dents are that they see, not where.
  const double placed = std::max(quality.protrusion.max, open.max);
  const SearchedMax dent = max_dent(surface, reconstruction, placed, kDentAccuracy * quality.diagonal, options.search);
  std::vector<WorstPlace> dents;
  if (dent.max > std::max(negligible, placed))
    dents.push_back({WorstKind::dent, dent.max, dent.place, outward_at(surface, dent.place), dent.ball});
  quality.hausdorff.max = std::max(quality.hausdorff.max, dent.max);
  quality.dent_upper = dent.upper;

  quality.worst = worst_protruding(options.worst_places);
  for (WorstPlace& place : quality.worst) place.outward = outward_at(surface, place.position);
  const auto max_open = worst_of(std::move(uncovered), options.worst_places, apart);
  quality.worst.insert(quality.worst.end(), max_open.begin(), max_open.end());
  quality.worst.insert(quality.worst.end(), dents.begin(), dents.end());
}

}  // namespace orchard::detail
