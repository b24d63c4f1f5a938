#include "orchard/medial/thickness.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "divided_mesh.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/spatial_order.h"
#include "tangent_ball.h"

namespace orchard {
namespace {

constexpr std::size_t kTask = 64, kReport = 16'384;  // places of one task, and between two calls of Progress
// The average area of a triangle after its edges have been halved until they are short enough, over the squared longest
// edge. Measured on meshes with few long edges.
constexpr double kAreaOfEdge = 0.21;

void require_in_range(const ThicknessOptions& options) {
  if (!(options.facing >= 0 && options.facing <= std::numbers::pi))
    throw InputError("thickness: the facing angle must be between 0 and pi radians (0 and 180 degrees)");
  if (!(options.smooth > 0 && options.smooth <= std::numbers::pi / 2))
    throw InputError("thickness: the smooth angle must be above 0 and at most pi / 2 radians (90 degrees)");
  if (options.samples == 0 || options.work == 0) throw InputError("thickness: samples and work must be at least 1");
}

std::vector<ThicknessAt> searched(const Surface& surface, const detail::SlabTree& tree,
                                  std::span<const SurfacePlace> places, const ThicknessOptions& options,
                                  const Progress& progress, double begin, double end) {
  std::vector<ThicknessAt> found(places.size());
  std::vector<Point> positions;
  positions.reserve(places.size());
  for (const SurfacePlace& place : places) positions.push_back(place.position);
  const std::vector<std::size_t> order = spatial_order(positions);
  for (std::size_t first = 0; first < places.size(); first += kReport) {
    const double part = static_cast<double>(first) / static_cast<double>(places.size());
    report_progress(progress, "thickness", begin + (end - begin) * part);
    const std::size_t last = std::min(places.size(), first + kReport);
    tbb::parallel_for(std::size_t{0}, (last - first + kTask - 1) / kTask, [&](std::size_t task) {
      detail::TangentBallSearch search(surface, tree, options);
      const std::size_t stop = std::min(last, first + (task + 1) * kTask);
      for (std::size_t i = first + task * kTask; i < stop; ++i) found[order[i]] = search.at(places[order[i]]);
    });
  }
  return found;
}

ThicknessValues values_of(const std::vector<ThicknessAt>& found) {
  ThicknessValues values;
  for (const ThicknessAt& at : found) {
    values.ball_diameter.push_back(at.diameter);
    values.thickness.push_back(at.thickness);
    values.contact_angle.push_back(at.angle);
    values.error.push_back(at.error);
    values.contacts.push_back(at.contact);
  }
  return values;
}

}  // namespace

std::vector<ThicknessAt> thickness_at(const Surface& surface, std::span<const SurfacePlace> places,
                                      const ThicknessOptions& options, const Progress& progress) {
  require_in_range(options);
  return searched(surface, detail::SlabTree(surface), places, options, progress, 0, 1);
}

LocalThickness local_thickness(const Surface& surface, const ThicknessOptions& options, const Progress& progress) {
  require_in_range(options);
  if (!surface.solid())
    throw InputError("thickness needs a closed, consistently oriented manifold: " + surface.report().faults() +
                     "; repair the mesh first");
  report_progress(progress, "thickness", 0);
  detail::DividedMesh divided =
      detail::divided_mesh(surface, std::sqrt(surface.report().area / (kAreaOfEdge * options.samples)));
  std::vector<SurfacePlace> middles;
  for (std::size_t i = 0; i < divided.mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = divided.mesh.triangles[i];
    const auto& vertices = divided.mesh.vertices;
    middles.push_back({(vertices[a] + vertices[b] + vertices[c]) / 3, divided.of_triangle[i], Feature::face});
  }
  const detail::SlabTree tree(surface);
  const double share =
      static_cast<double>(divided.places.size()) / static_cast<double>(divided.places.size() + middles.size());
  LocalThickness result;
  result.at_vertices = values_of(searched(surface, tree, divided.places, options, progress, 0, share));
  result.at_triangles = values_of(searched(surface, tree, middles, options, progress, share, 1));
  result.mesh = std::move(divided.mesh);
  result.of_triangle = std::move(divided.of_triangle);
  return result;
}

}  // namespace orchard
