#include "medial/medial_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace orchard::apps {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr double kMinTurn = 10 / kDegrees;  // of an edge that sheets might reach: below, it is curvature
constexpr double kSlack = 1.5;              // times a bound: what is beyond that, the bound does not explain

Advice option_with(const std::string& option, const std::string& value, const std::string& more = {}) {
  return {fmt::format("--{} {}{}", option, value, more), option, value};
}

Advice more_points(const AxisOrigin& origin) {
  if (origin.own_points) return {"more points of your own there"};
  return option_with("samples", std::to_string(2 * origin.tuning->samples.value_or(kStandardSamples)));
}

Advice refine_or_more_points(const AxisOrigin& origin) { return {"no --raw, or " + more_points(origin).text}; }

// The most that the surface turns at a convex edge that comes within `reach` of a place, in radians; 0 if there is
// none.
double sharpest_edge_near(const Surface& surface, const Point& position, double reach) {
  std::vector<Index> triangles;
  surface.triangles_near({position, reach}, triangles);
  double sharpest = 0;
  for (const Index triangle : triangles) {
    const std::array<Point, 3> corners = surface.corners(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = surface.neighbors(triangle)[k];
      if (other == kNone) continue;
      const Point &a = corners[k], &b = corners[(k + 1) % 3];
      if (closest_point_of_triangle(position, a, b, b).distance > reach) continue;
      const Vector &n = surface.normal(triangle), &m = surface.normal(other);
      if (n.cross(m).dot(b - a) < 0) continue;  // the surface turns inward
      sharpest = std::max(sharpest, std::atan2(n.cross(m).norm(), n.dot(m)));
    }
  }
  return sharpest;
}

Advice about_protrusion(const WorstPlace& place, const AxisOrigin& origin) {
  const MedialTuning& tuning = *origin.tuning;
  if (!tuning.refine) return refine_or_more_points(origin);
  if (place.value <= kSlack * tuning.refinement.tolerance)
    return option_with("linear-error", fmt::format("{:.2g}", 50 * place.value));
  return more_points(origin);
}

Advice about_coverage(const WorstPlace& place, const Surface& surface, const AxisOrigin& origin) {
  const MedialTuning& tuning = *origin.tuning;
  if (tuning.prune_degrees > 0) {
    const std::string angle = fmt::format("angle={:.3g}", 0.5 * tuning.prune_degrees);
    return option_with("prune", angle);
  }
  if (tuning.options.prune.scale > 1) return option_with("prune", "scale=1");
  if (!tuning.refine) return refine_or_more_points(origin);
  const double diagonal = surface.bounding_box().diagonal().norm();
  const double turn = sharpest_edge_near(surface, place.position, 1e-9 * diagonal + 0.5 * place.value * diagonal);
  if (turn > kMinTurn && place.value < tuning.refinement.feature_loss)
    return option_with("feature-loss", fmt::format("{:.2g}", 50 * place.value), ", for the edge here");
  if (turn < kMinTurn && place.value <= kSlack * tuning.refinement.border_loss)
    return option_with("border-loss", fmt::format("{:.2g}", 50 * place.value));
  return more_points(origin);
}

Advice about_dent(const AxisOrigin& origin) {
  if (!origin.tuning->refine) return refine_or_more_points(origin);
  return more_points(origin);
}

}  // namespace

Advice advice(const WorstPlace& place, const Surface& surface, const AxisOrigin& origin) {
  if (origin.tuning == nullptr) return {"nothing here: the axis is a file"};
  if (origin.cuts_itself) return {"--wrap, since the mesh cuts itself"};
  switch (place.kind) {
    case WorstKind::protrusion:
      return about_protrusion(place, origin);
    case WorstKind::coverage:
      return about_coverage(place, surface, origin);
    case WorstKind::dent:
      break;
  }
  return about_dent(origin);
}

}  // namespace orchard::apps
