#include "orchard/medial/promise.h"

#include <vector>

#include "boundary_reach.h"
#include "orchard/geometry/error.h"
#include "quality_parts.h"

namespace orchard {
namespace {

constexpr const char* kPromiseStage = "checking what was promised";
constexpr double kPromiseAccuracy = 1e-5;  // diagonals: how near the bounds on the largest values are brought
constexpr double kKnown =
    0.97;  // of the limit: the proven bound is up to 2 % more than that, so it stays below the limit
constexpr Index kMaxCells = 300'000;  // of the search for what protrudes

}  // namespace

PromiseCheck check_promise(const Surface& surface, const MedialMesh& mesh, const AxisPromise& promise,
                           const Progress& progress) {
  if (!surface.solid())
    throw InputError("a medial axis is compared with a solid: " + surface.report().faults() +
                     "; repair the mesh first");
  validate(mesh);
  report_progress(progress, kPromiseStage, 0);
  PromiseCheck check{.promise = promise, .found = topology(mesh), .wanted = solid_topology(surface)};
  const double diagonal = surface.bounding_box().diagonal().norm(), accuracy = kPromiseAccuracy * diagonal;
  if (promise.open) {
    const double limit = *promise.open * diagonal;
    const double known = limit - accuracy;  // so that the proven bound is at most the limit
    const detail::MaxOverTriangles open = detail::max_coverage(
        surface, detail::Reconstruction(mesh), {.max = known, .upper = known, .place = Point::Zero()}, diagonal);
    if (open.max > limit) check.open = open.max / diagonal;
    check.open_upper = open.upper / diagonal;
  }
  report_progress(progress, kPromiseStage, 0.5);
  if (promise.protrusion) {
    const double limit = *promise.protrusion * diagonal;
    std::vector<Sphere> balls;
    balls.reserve(mesh.size());
    for (Index v = 0; v < mesh.size(); ++v) balls.push_back({mesh.centers[v], mesh.radii[v]});
    const std::vector<detail::BallDepth> depths = detail::depths_of(surface, balls);
    const detail::SearchedMax beyond = detail::max_protrusion(surface, mesh, {.vertices = depths, .triangles = {}},
                                                              kKnown * limit, accuracy, kMaxCells);
    if (beyond.max > limit) check.protrusion = beyond.max / diagonal;
    check.protrusion_upper = beyond.upper / diagonal;
  }
  report_progress(progress, kPromiseStage, 1);
  return check;
}

}  // namespace orchard
