#include "orchard/medial/prune.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "../balls/axis_of_balls.h"
#include "../refine/cut_at_level.h"
#include "orchard/geometry/error.h"
#include "orchard/medial/importance.h"
#include "prune_cells.h"

namespace orchard {
namespace {

// Diagonals: contacts between which a ball would lose less are one contact of the balls where triangles are cut.
constexpr double kMerging = 2.5e-4;
constexpr std::size_t kMaxContacts = 4;  // of the balls that triangles can be cut at

void check(const PruneOptions& options) {
  if (!(options.angle >= 0 && options.angle <= std::numbers::pi))
    throw InputError("the angle of pruning must be between 0 and pi radians");
  if (!(options.scale >= 1 && std::isfinite(options.scale)))
    throw InputError("the scale of pruning must be at least 1");
  const auto check_length = [](const char* name, double value) {
    if (!(value >= 0 && std::isfinite(value)))
      throw InputError(std::string("the ") + name + " of pruning must be a finite number of diagonals, at least 0");
  };
  check_length("border loss", options.border_loss);
  check_length("lambda", options.lambda);
  check_length("erosion", options.erosion);
  check_length("geodesic length", options.geodesic);
}

// Whether an axis consists of balls with few contacts, edges and triangles. Refined ones do; imported ones have a
// contact for each surface point around a ball.
bool can_be_cut(const MedialAxis& axis) {
  if (axis.topology_faces.size() > 0) return false;
  for (Index face = 0; face < axis.faces.size(); ++face)
    if (axis.faces[face].size() != 3) return false;
  for (Index v = 0; v < axis.size(); ++v)
    if (axis.forming_points[v].size() > kMaxContacts) return false;
  return true;
}

detail::BallComplex complex_of(const Surface& surface, const MedialAxis& axis) {
  detail::BallComplex complex;
  for (Index v = 0; v < axis.size(); ++v) {
    detail::ExactBall& ball = complex.balls.emplace_back();
    ball.center = axis.centers[v];
    ball.radius = axis.radii[v];
    for (const Index point : axis.forming_points[v]) {
      ClosestPoint contact = surface.closest(axis.points[point]);
      contact.position = axis.points[point];
      contact.distance = (contact.position - ball.center).norm();
      ball.contacts[static_cast<std::size_t>(ball.count++)] = contact;
    }
    ball.exact = ball.count > 1;
    for (const Index next : axis.neighbors[v])
      if (v < next) complex.edges.push_back({v, next});
  }
  for (Index face = 0; face < axis.faces.size(); ++face) {
    const auto corners = axis.faces[face];
    complex.triangles.push_back({corners[0], corners[1], corners[2]});
  }
  complex.complete();
  return complex;
}

MedialAxis cut(const Surface& surface, const MedialAxis& axis, const std::vector<double>& over_limit, double diagonal) {
  detail::BallComplex complex = complex_of(surface, axis);
  detail::cut_where_below(surface, complex, over_limit, kMerging * diagonal);
  MedialAxis result = detail::axis_of_balls(surface, complex);
  result.stems = axis.stems;
  result.bridges = axis.bridges;
  result.left_out = axis.left_out;
  return result;
}

}  // namespace

MedialAxis prune(const Surface& surface, const MedialAxis& axis, const PruneOptions& options,
                 const Progress& progress) {
  check(options);
  if (options.removes_nothing() || axis.size() == 0) return axis;
  const double diagonal = surface.bounding_box().diagonal().norm();
  const bool cuts = can_be_cut(axis);
  std::vector<double> over_limit(axis.size(), std::numeric_limits<double>::infinity());
  const auto apply = [&](ImportanceMeasure measure, double limit) {
    const std::vector<double> values = importance(surface, axis, measure, progress);
    for (Index v = 0; v < axis.size(); ++v) over_limit[v] = std::min(over_limit[v], values[v] / limit);
  };
  if (options.scale > 1) apply(ImportanceMeasure::scale, options.scale);
  if (options.border_loss > 0) apply(ImportanceMeasure::border_loss, options.border_loss * diagonal);
  if (options.erosion > 0) apply(ImportanceMeasure::erosion, options.erosion * diagonal);
  if (options.geodesic > 0) apply(ImportanceMeasure::geodesic, options.geodesic * diagonal);
  if (!cuts)
    return detail::prune_cells(axis, {.angle = options.angle, .lambda = options.lambda * diagonal}, over_limit);
  if (options.angle > 0) apply(ImportanceMeasure::angle, options.angle);
  if (options.lambda > 0) apply(ImportanceMeasure::lambda, options.lambda * diagonal);
  return cut(surface, axis, over_limit, diagonal);
}

}  // namespace orchard
