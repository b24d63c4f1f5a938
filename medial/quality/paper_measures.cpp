#include "orchard/medial/paper_measures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "../axis/incidence.h"
#include "envelope_samples.h"
#include "orchard/geometry/error.h"
#include "quality_parts.h"

namespace orchard {
namespace {

constexpr double kNearContact =
    0.05;  // of the radius: places farther than the nearest one by more than this are not contacts
// Of the diagonal: the same tolerance for small balls, whose centres are rounded in files.
constexpr double kFileDigits = 1e-3;
// Cosine of 30 degrees: contacts seen at a smaller angle count as one.
constexpr double kSameContact = 0.8660254037844387;

// Makes a surface of degenerate triangles, for queries of the nearest point.
Surface cloud_of(const std::vector<Point>& points) {
  TriangleMesh mesh;
  mesh.vertices = points;
  for (Index i = 0; i < points.size(); ++i) mesh.triangles.push_back({i, i, i});
  return Surface(std::move(mesh));
}

struct OneWay {
  double max = 0, mean = 0;
};
OneWay distances(const std::vector<Point>& from, const Surface& to) {
  std::vector<double> all(from.size());
  tbb::parallel_for(std::size_t{0}, from.size(), [&](std::size_t i) { all[i] = to.distance(from[i]); });
  const Spread spread = detail::spread_of(all);
  return {spread.max, spread.mean};
}

void measure_samples(const MedialMesh& mesh, const std::vector<Point>& surface_points, double diagonal,
                     const PaperOptions& options, PaperMeasures& result) {
  const detail::Reconstruction reconstruction(mesh);
  const std::vector<Point> boundary = detail::envelope_samples(mesh, reconstruction, options.samples, options.seed);
  result.chamfer = result.sampled_hausdorff = std::nan("");
  if (boundary.empty() || surface_points.empty()) return;
  const OneWay to = distances(surface_points, cloud_of(boundary)), from = distances(boundary, cloud_of(surface_points));
  result.chamfer = (to.mean + from.mean) / diagonal;
  result.sampled_hausdorff = std::max(to.max, from.max) / diagonal;
}

void measure_cover(const Surface& surface, const MedialMesh& mesh, const std::vector<Point>& points,
                   const PaperOptions& options, PaperMeasures& result) {
  const MedialMesh balls{.centers = mesh.centers, .radii = mesh.radii, .edges = {}, .triangles = {}};
  const detail::Reconstruction alone(balls);
  std::vector<double> off(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) { off[i] = alone.distance(points[i]); });
  const double side = surface.bounding_box().sizes().maxCoeff(), dilation = options.dilation * side;
  const auto within = std::count_if(off.begin(), off.end(), [&](double own) { return own < dilation; });
  result.covered = static_cast<double>(within) / static_cast<double>(std::max<std::size_t>(off.size(), 1));
  for (const double own : off) result.dilation_needed = std::max(result.dilation_needed, own / side);
}

// Returns at how many places a ball touches the surface.
Index contacts(const Surface& surface, const Point& center, double diagonal) {
  const double nearest = surface.distance(center);
  const double reach = nearest + std::max(kNearContact * nearest, kFileDigits * diagonal);
  std::vector<Index> near;
  surface.triangles_near({center, reach}, near);
  std::vector<std::pair<double, Vector>> feet;
  for (const Index t : near) {
    const auto [a, b, c] = surface.corners(t);
    const ClosestPoint foot = closest_point_of_triangle(center, a, b, c);
    if (foot.distance <= reach) feet.emplace_back(foot.distance, (foot.position - center).normalized());
  }
  std::sort(feet.begin(), feet.end(), [](const auto& a, const auto& b) {
    return std::make_tuple(a.first, a.second.x(), a.second.y()) < std::make_tuple(b.first, b.second.x(), b.second.y());
  });
  std::vector<Vector> apart;
  for (const auto& foot : feet) {
    const bool known = std::any_of(apart.begin(), apart.end(),
                                   [&](const Vector& other) { return foot.second.dot(other) > kSameContact; });
    if (!known) apart.push_back(foot.second);
  }
  return static_cast<Index>(apart.size());
}

void measure_structure(const Surface& surface, const MedialMesh& mesh, double diagonal, const PaperOptions& options,
                       PaperMeasures& result) {
  const detail::CellIncidence at(mesh.edges, mesh.triangles, mesh.size());
  std::vector<Index> seams(mesh.centers.size(), 0), looked_at;
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    if (at.triangles_at[e].size() < 3) continue;
    for (const Index end : mesh.edges[e]) ++seams[end];
  }
  for (Index v = 0; v < mesh.size(); ++v) {
    // Balls on sharp edges of the surface are skipped, because they touch it in all directions.
    if (seams[v] > 0 && mesh.radii[v] > kFileDigits * diagonal) looked_at.push_back(v);
  }
  result.structure_balls = static_cast<Index>(looked_at.size());
  result.wrong_structure = std::nan("");
  if (looked_at.empty()) return;
  const std::size_t step = (looked_at.size() - 1) / options.structure_cells + 1;
  std::vector<std::uint8_t> wrong((looked_at.size() - 1) / step + 1, 0);
  tbb::parallel_for(std::size_t{0}, wrong.size(), [&](std::size_t i) {
    const Index v = looked_at[i * step];
    wrong[i] = contacts(surface, mesh.centers[v], diagonal) < (seams[v] > 2 ? 4u : 3u);
  });
  result.wrong_structure =
      static_cast<double>(std::count(wrong.begin(), wrong.end(), 1)) / static_cast<double>(wrong.size());
}

}  // namespace

PaperMeasures paper_measures(const Surface& surface, const MedialMesh& mesh, const PaperOptions& options) {
  if (!surface.solid())
    throw InputError("measuring an axis needs a solid: " + surface.report().faults() + "; repair the mesh first");
  validate(mesh);
  PaperMeasures result;
  const double diagonal = surface.bounding_box().diagonal().norm();
  std::vector<Point> points;
  for (const detail::SurfaceSample& sample : detail::quality_samples(surface, options.samples, options.seed))
    points.push_back(sample.position);
  measure_samples(mesh, points, diagonal, options, result);
  measure_cover(surface, mesh, points, options, result);
  measure_structure(surface, mesh, diagonal, options, result);
  return result;
}

}  // namespace orchard
