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

bool removes_nothing(ImportanceMeasure measure, double limit) {
  return limit == (measure == ImportanceMeasure::scale ? 1 : 0);
}

// The places of an axis that are below the limits of some measures.
class Insignificant {
 public:
  Insignificant(const Surface& surface, const MedialAxis& axis)
      : surface_(surface),
        axis_(axis),
        cuts_(can_be_cut(axis)),
        over_limit_(axis.size(), std::numeric_limits<double>::infinity()) {}

  // Whether whole cells have a value of their own for a measure, so that those of the vertices are not needed.
  bool is_of_cells(ImportanceMeasure measure) const {
    return !cuts_ && (measure == ImportanceMeasure::angle || measure == ImportanceMeasure::lambda);
  }

  // Adds those that a measure of cells or vertices finds. `limit` has the unit of the values, which are not read if
  // is_of_cells(measure).
  void add(ImportanceMeasure measure, double limit, const std::vector<double>& values) {
    if (is_of_cells(measure)) {
      (measure == ImportanceMeasure::angle ? cells_.angle : cells_.lambda) = limit;
      return;
    }
    for (Index v = 0; v < axis_.size(); ++v) over_limit_[v] = std::min(over_limit_[v], values[v] / limit);
  }

  MedialAxis removed() const {
    if (!cuts_) return detail::prune_cells(axis_, cells_, over_limit_);
    detail::BallComplex complex = complex_of(surface_, axis_);
    detail::cut_where_below(surface_, complex, over_limit_, kMerging * surface_.bounding_box().diagonal().norm());
    MedialAxis result = detail::axis_of_balls(surface_, complex);
    result.stems = axis_.stems;
    result.bridges = axis_.bridges;
    result.left_out = axis_.left_out;
    return result;
  }

 private:
  const Surface& surface_;
  const MedialAxis& axis_;
  const bool cuts_;
  detail::CellLimits cells_;
  std::vector<double> over_limit_;
};

}  // namespace

double& limit_of(PruneOptions& options, ImportanceMeasure measure) {
  switch (measure) {
    case ImportanceMeasure::angle:
      return options.angle;
    case ImportanceMeasure::border_loss:
      return options.border_loss;
    case ImportanceMeasure::lambda:
      return options.lambda;
    case ImportanceMeasure::scale:
      return options.scale;
    case ImportanceMeasure::erosion:
      return options.erosion;
    case ImportanceMeasure::geodesic:
      return options.geodesic;
  }
  throw InputError("pruning: not a measure of importance");
}

MedialAxis prune(const Surface& surface, const MedialAxis& axis, const PruneOptions& options,
                 const Progress& progress) {
  check(options);
  if (options.removes_nothing() || axis.size() == 0) return axis;
  PruneOptions limits = options;
  Insignificant insignificant(surface, axis);
  for (const ImportanceMeasure measure : kImportanceMeasures) {
    double limit = limit_of(limits, measure);
    if (removes_nothing(measure, limit)) continue;
    if (is_length(measure)) limit *= surface.bounding_box().diagonal().norm();
    insignificant.add(
        measure, limit,
        insignificant.is_of_cells(measure) ? std::vector<double>{} : importance(surface, axis, measure, progress));
  }
  return insignificant.removed();
}

MedialAxis prune(const Surface& surface, const MedialAxis& axis, ImportanceMeasure measure,
                 const std::vector<double>& values, double limit) {
  if (values.size() != axis.size()) throw InputError("pruning needs one value of the measure for each vertex");
  PruneOptions options;
  limit_of(options, measure) = is_length(measure) ? limit / surface.bounding_box().diagonal().norm() : limit;
  check(options);
  if (options.removes_nothing() || axis.size() == 0) return axis;
  Insignificant insignificant(surface, axis);
  insignificant.add(measure, limit, values);
  return insignificant.removed();
}

}  // namespace orchard
