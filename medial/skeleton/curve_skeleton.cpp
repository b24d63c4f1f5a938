#include "orchard/medial/curve_skeleton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "curve_burn.h"
#include "fine_complex.h"
#include "orchard/geometry/error.h"
#include "sheet_burn.h"
#include "skeleton_arcs.h"
#include "straighten.h"

namespace orchard {
namespace {

constexpr double kMaxMove = 2;  // in edge lengths: the farthest that straightening moves a vertex

void require_skeleton_options(const SkeletonOptions& options) {
  if (!(options.erosion >= 0 && std::isfinite(options.erosion)))
    throw InputError("skeleton: erosion must be at least 0 and finite");
  if (!(options.ratio >= 0.2 && options.ratio < 1))
    throw InputError("skeleton: ratio must be at least 0.2 and below 1");
  if (!(options.edge_length > 0 && std::isfinite(options.edge_length)))
    throw InputError("skeleton: edge_length must be above 0 and finite");
  if (options.smoothing < 0) throw InputError("skeleton: smoothing must be at least 0");
}

// Collects the rest of a burned complex, with its vertices renumbered.
class SkeletonMaker {
 public:
  SkeletonMaker(const MedialMesh& fine, const detail::CellIncidence& at, const detail::SheetBurn& burn,
                const detail::PrunedCurves& curves)
      : fine_(fine), at_(at), burn_(burn), curves_(curves), renumbered_(fine.centers.size(), kNone) {}

  CurveSkeleton run() {
    for (Index vertex = 0; vertex < fine_.size(); ++vertex) {
      if (!curves_.vertex_alive[vertex]) continue;
      renumbered_[vertex] = static_cast<Index>(result_.vertices.size());
      result_.vertices.push_back(fine_.centers[vertex]);
      result_.burn_times.push_back(burn_.vertex_times[vertex]);
    }
    for (Index edge = 0; edge < fine_.edges.size(); ++edge) {
      if (!is_curve(edge)) continue;
      const auto [a, b] = fine_.edges[edge];
      result_.edges.push_back({renumbered_[a], renumbered_[b]});
      significance_.push_back(curves_.significance[edge]);
      bare_.push_back(at_.triangles_at[edge].empty() ? 1 : 0);
    }
    for (Index triangle = 0; triangle < fine_.triangles.size(); ++triangle) {
      if (!burn_.triangle_alive[triangle]) continue;
      const auto& [a, b, c] = fine_.triangles[triangle];
      result_.sheets.push_back({renumbered_[a], renumbered_[b], renumbered_[c]});
    }
    return std::move(result_);
  }

  const std::vector<double>& significance() const { return significance_; }  // of each edge of the result
  const std::vector<std::uint8_t>& bare() const { return bare_; }            // likewise

 private:
  bool is_curve(Index edge) const {
    return curves_.edge_alive[edge] && detail::only(at_.triangles_at[edge], burn_.triangle_alive) == kNone &&
           !std::isnan(burn_.isolated[edge]);
  }

  const MedialMesh& fine_;
  const detail::CellIncidence& at_;
  const detail::SheetBurn& burn_;
  const detail::PrunedCurves& curves_;
  std::vector<Index> renumbered_;
  std::vector<double> significance_;
  std::vector<std::uint8_t> bare_;
  CurveSkeleton result_;
};

// Ends of curves, curves of the axis and corners of closed sheets are not moved.
std::vector<std::uint8_t> fixed_vertices(const CurveSkeleton& skeleton, const std::vector<std::uint8_t>& bare) {
  std::vector<std::uint8_t> fixed(skeleton.vertices.size(), 0), degree(skeleton.vertices.size(), 0);
  for (std::size_t e = 0; e < skeleton.edges.size(); ++e) {
    for (const Index end : skeleton.edges[e]) {
      if (degree[end] < 2) ++degree[end];
      if (bare[e]) fixed[end] = 1;
    }
  }
  for (const auto& triangle : skeleton.sheets) {
    for (const Index corner : triangle) fixed[corner] = 1;
  }
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (degree[i] < 2) fixed[i] = 1;
  }
  return fixed;
}

void straighten_curves(const Surface& surface, const MedialMesh& axis, const std::vector<std::uint8_t>& bare,
                       int rounds, CurveSkeleton& skeleton) {
  if (axis.triangles.empty() || rounds == 0) return;
  const Surface sheets(TriangleMesh{axis.centers, axis.triangles});
  detail::CurveGraph graph{
      .vertices = skeleton.vertices, .edges = skeleton.edges, .fixed = fixed_vertices(skeleton, bare)};
  const detail::Straightened done = detail::straighten(graph, surface, sheets, kMaxMove * skeleton.edge_length, rounds);
  skeleton.vertices = std::move(graph.vertices);
  skeleton.max_moved = done.max_moved;
  skeleton.axis_distance = done.axis_distance;
}

}  // namespace

CurveSkeleton curve_skeleton(const Surface& surface, const MedialMesh& axis, const SkeletonOptions& options,
                             const Progress& progress) {
  require_skeleton_options(options);
  validate(axis);
  report_progress(progress, "skeleton", 0);
  const double diagonal = surface.bounding_box().diagonal().norm();
  const double length = detail::affordable_edge_length(axis, options.edge_length * diagonal);
  const MedialMesh fine = detail::divided(axis, length);
  const detail::CellIncidence at(fine.edges, fine.triangles, fine.size());
  report_progress(progress, "skeleton", 0.3);
  const detail::SheetBurn burn = detail::burn_sheets(fine, at);
  report_progress(progress, "skeleton", 0.6);
  const detail::PrunedCurves curves = detail::prune_curves(fine, at, burn, options, diagonal, length);
  report_progress(progress, "skeleton", 0.8);
  SkeletonMaker maker(fine, at, burn, curves);
  CurveSkeleton skeleton = maker.run();
  skeleton.edge_length = length;
  straighten_curves(surface, axis, maker.bare(), options.smoothing, skeleton);
  for (const Point& vertex : skeleton.vertices) skeleton.radii.push_back(surface.distance(vertex));
  detail::trace_arcs(maker.significance(), maker.bare(), skeleton);
  report_progress(progress, "skeleton", 1);
  return skeleton;
}

MedialMesh medial_mesh(const CurveSkeleton& skeleton) {
  MedialMesh mesh{skeleton.vertices, skeleton.radii, skeleton.edges, skeleton.sheets};
  complete(mesh);
  return mesh;
}

std::vector<double> burn_times(const MedialMesh& axis, double diagonal, double edge_length) {
  require_skeleton_options({.edge_length = edge_length});
  if (!(diagonal > 0 && std::isfinite(diagonal))) throw InputError("burn times: the diagonal must be above 0");
  validate(axis);
  const MedialMesh fine = detail::divided(axis, detail::affordable_edge_length(axis, edge_length * diagonal));
  const detail::CellIncidence at(fine.edges, fine.triangles, fine.size());
  std::vector<double> times = detail::burn_sheets(fine, at).vertex_times;
  times.resize(axis.centers.size());
  return times;
}

}  // namespace orchard
