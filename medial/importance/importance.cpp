#include "orchard/medial/importance.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

#include "../ball_tree.h"
#include "../balls/exact_ball.h"
#include "orchard/geometry/angle.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/min_ball.h"
#include "orchard/medial/curve_skeleton.h"
#include "orchard/medial/prune.h"
#include "surface_paths.h"

namespace orchard {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPathEdge = 1.0 / 128;  // diagonals: the longest edge of the graph in which paths are found

std::vector<double> border_losses(const MedialAxis& axis) {
  std::vector<double> result = contact_angles(axis);
  for (Index v = 0; v < axis.size(); ++v) result[v] = detail::BallSolver::loss(axis.radii[v], result[v]);
  return result;
}

std::vector<double> lambdas(const MedialAxis& axis) {
  std::vector<double> result(axis.size());
  tbb::parallel_for(Index{0}, axis.size(), [&](Index v) {
    std::vector<Point> contacts;
    for (const Index point : axis.forming_points[v]) contacts.push_back(axis.points[point]);
    result[v] = minimal_ball(contacts).radius;
  });
  return result;
}

// A ball i lies in a larger ball k, both scaled by s, if |c_i - c_k| + s r_i <= s r_k. The least such s over all k is
// a minimum of quotients, which Dinkelbach's method finds: for a given s, the k that makes the difference of both sides
// most negative has a smaller quotient, until none is negative.
std::vector<double> scale_ratios(const MedialAxis& axis) {
  std::vector<double> result(axis.size(), kInfinity);
  std::vector<Box> boxes;
  for (const Point& center : axis.centers) boxes.emplace_back(center);
  const detail::BallTree tree(std::move(boxes), axis.radii);
  const auto largest = static_cast<Index>(std::max_element(axis.radii.begin(), axis.radii.end()) - axis.radii.begin());
  tbb::parallel_for(Index{0}, axis.size(), [&](Index i) {
    const double radius = axis.radii[i];
    const auto quotient = [&](Index k) {
      return (axis.centers[k] - axis.centers[i]).norm() / (axis.radii[k] - radius);
    };
    if (!(axis.radii[largest] > radius)) return;
    for (Index best = largest; best != kNone;) {
      const double scale = quotient(best);
      if (!(scale < result[i])) break;
      result[i] = scale;
      best = kNone;
      double least = -scale * radius;
      tree.min(
          axis.centers[i], least,
          [&](Index k) {
            if (!(axis.radii[k] > radius)) return kInfinity;
            const double value = (axis.centers[k] - axis.centers[i]).norm() - scale * axis.radii[k];
            if (value < least) {
              least = value;
              best = k;
            }
            return value;
          },
          scale);
    }
    result[i] = std::max(result[i], 1.0);
  });
  return result;
}

std::vector<double> erosion_thickness(const Surface& surface, const MedialAxis& axis) {
  std::vector<double> result = burn_times(medial_mesh(axis), surface.bounding_box().diagonal().norm());
  result.resize(axis.size());
  for (Index v = 0; v < axis.size(); ++v) result[v] = std::max(result[v] - axis.radii[v], 0.0);
  return result;
}

// The two forming points of a vertex that are seen farthest apart; kNone if there are fewer than two.
std::array<Index, 2> widest_pair(const MedialAxis& axis, Index v) {
  std::array<Index, 2> best{kNone, kNone};
  double widest = -1;
  const auto points = axis.forming_points[v];
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double angle =
          angle_between(axis.points[points[i]] - axis.centers[v], axis.points[points[k]] - axis.centers[v]);
      if (angle <= widest) continue;
      widest = angle;
      best = {points[k], points[i]};
    }
  }
  return best;
}

std::vector<double> geodesics(const Surface& surface, const MedialAxis& axis, const Progress& progress) {
  constexpr const char* kStage = "paths on the surface";
  report_progress(progress, kStage, 0);
  std::vector<double> result(axis.size(), 0);
  const detail::SurfacePaths paths(surface, kPathEdge * surface.bounding_box().diagonal().norm());
  tbb::enumerable_thread_specific<detail::SurfacePaths::Search> searches([&] { return paths.search(); });
  constexpr Index kAtOnce = 4096;  // between two reports of progress
  for (Index first = 0; first < axis.size(); first += kAtOnce) {
    const Index last = std::min(axis.size(), first + kAtOnce);
    tbb::parallel_for(tbb::blocked_range<Index>(first, last, 16), [&](const auto& range) {
      for (Index v = range.begin(); v != range.end(); ++v) {
        const auto [a, b] = widest_pair(axis, v);
        if (a != kNone)
          result[v] = paths.length(surface.closest(axis.points[a]), surface.closest(axis.points[b]), searches.local());
      }
    });
    report_progress(progress, kStage, static_cast<double>(last) / axis.size());
  }
  return result;
}

}  // namespace

const char* name_of(ImportanceMeasure measure) {
  constexpr std::array kNames{"angle", "border_loss", "lambda", "scale", "erosion", "geodesic"};
  static_assert(kNames.size() == kImportanceMeasures.size());
  return kNames[static_cast<std::size_t>(measure)];
}

bool is_length(ImportanceMeasure measure) {
  return measure != ImportanceMeasure::angle && measure != ImportanceMeasure::scale;
}

std::vector<double> importance(const Surface& surface, const MedialAxis& axis, ImportanceMeasure measure,
                               const Progress& progress) {
  if (axis.size() == 0) throw InputError("the importance of an axis: it has no vertices");
  switch (measure) {
    case ImportanceMeasure::angle:
      return contact_angles(axis);
    case ImportanceMeasure::border_loss:
      return border_losses(axis);
    case ImportanceMeasure::lambda:
      return lambdas(axis);
    case ImportanceMeasure::scale:
      return scale_ratios(axis);
    case ImportanceMeasure::erosion:
      return erosion_thickness(surface, axis);
    case ImportanceMeasure::geodesic:
      return geodesics(surface, axis, progress);
  }
  throw InputError("the importance of an axis: not a measure");
}

}  // namespace orchard
