#include "orchard/spheretree/sphere_audit.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "orchard/covering/coverage.h"
#include "orchard/covering/uncovered_part.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/spheretree/tree.h"
#include "sampled_distances.h"

namespace orchard {
namespace {

// How far apart the bounds on the largest gap may be: a part of the bounding radius or a part of the gap, whichever is
// larger.
constexpr DistanceTolerance kGapTolerance{1e-5, 1e-3};

void require_balls(std::span<const Sphere> balls) {
  if (balls.empty()) throw InputError("the set has no sphere, so there is nothing to audit");
  for (std::size_t i = 0; i < balls.size(); ++i)
    if (!balls[i].center.allFinite() || !(balls[i].radius > 0) || !std::isfinite(balls[i].radius))
      throw InputError("sphere " + std::to_string(i) +
                       " has no finite centre or no positive, finite radius; leave it out");
}

void find_open(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options,
               const Progress& progress, SphereAudit& audit) {
  const Point origin = surface.bounding_box().center();
  const std::vector<PathBall> leaves = path_balls(balls, origin);
  const Coverage coverage = surface_coverage(surface, leaves, origin, progress);
  audit.covered = coverage.complete();
  if (audit.covered) return;
  std::vector<Index> triangles;
  for (const UncoveredTriangle& uncovered : coverage.uncovered) triangles.push_back(uncovered.triangle);
  const UncoveredPart part = uncovered_part(surface, triangles, PathForest(leaves), origin,
                                            {options.area_tolerance, kGapTolerance, options.max_cells});
  audit.open_area = part.area;
  audit.likely_open_area = part.likely_area;
  audit.largest_gap = part.distance;
  audit.gap_place = part.farthest + origin;
}

bool touches(const Surface& surface, const Sphere& ball) {
  return surface.distance(ball.center) <= ball.radius || (surface.solid() && surface.inside(ball.center));
}

// Finds the ball that protrudes farthest from the solid. Only balls whose simple bound allows that are measured.
void find_protrusion(const Surface& surface, std::span<const Sphere> balls, SphereAudit::BesideSolid& beside) {
  std::vector<double> bounds(balls.size());
  tbb::parallel_for(std::size_t{0}, balls.size(), [&](std::size_t b) {
    bounds[b] = distance_bound(surface.signed_distance(balls[b].center), balls[b].radius);
  });
  std::vector<Index> order(balls.size());
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return bounds[a] > bounds[b]; });
  for (Index b : order) {
    if (bounds[b] <= beside.protrusion.upper) break;
    const Bounds own = farthest_from_solid(surface, balls[b]);
    if (own.upper > 0 && own.lower >= beside.protrusion.lower) beside.protruding = b;
    beside.protrusion.lower = std::max(beside.protrusion.lower, own.lower);
    beside.protrusion.upper = std::max(beside.protrusion.upper, own.upper);
  }
}

}  // namespace

double gap_from(std::span<const Sphere> balls, const Point& point) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Sphere& ball : balls) gap = std::min(gap, (point - ball.center).norm() - ball.radius);
  return gap;
}

bool SphereAudit::only_tangent(double bounding_radius) const {
  return !covered && largest_gap.upper <= tolerance::kTangent * bounding_radius;
}

SphereAudit audit_spheres(const Surface& surface, std::span<const Sphere> balls, const SphereAuditOptions& options,
                          const Progress& progress) {
  require_balls(balls);
  SphereAudit audit;
  audit.spheres = static_cast<Index>(balls.size());
  audit.area = surface.report().area;
  audit.touches = std::any_of(balls.begin(), balls.end(), [&](const Sphere& ball) { return touches(surface, ball); });
  find_open(surface, balls, options, progress, audit);
  if (!surface.solid()) return audit;
  SphereAudit::BesideSolid& beside = audit.beside_solid.emplace(SphereAudit::BesideSolid{});
  report_progress(progress, "measuring spheres", 0);
  find_protrusion(surface, balls, beside);
  report_progress(progress, "measuring spheres", 0.3);
  beside.volume = union_volume(surface, balls, options.rays);
  report_progress(progress, "measuring spheres", 0.5);
  const detail::SurfaceGaps gaps = detail::surface_gaps(surface, balls, options);
  beside.mean = detail::mean_distances(surface, balls, gaps, options);
  beside.curobo = detail::curobo_figures(surface, balls, beside.volume, gaps);
  return audit;
}

}  // namespace orchard
