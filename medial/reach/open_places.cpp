#include "open_places.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <vector>

#include "../gaps/point_tree.h"
#include "../quality/reconstruction.h"
#include "recent_cells.h"

namespace orchard::detail {
namespace {

constexpr Index kProbes = 4;         // random places for each surface point
constexpr double kSeparation = 0.1;  // in mean spacings: the smallest distance between two points

}  // namespace

SurfaceSampling open_places(const Surface& surface, const MedialMesh& mesh, const SurfaceSampling& sampling,
                            double limit) {
  const SurfaceSampling probes =
      sample_surface(surface, {.face_points = kProbes * sampling.size(), .edge_points = 0, .iterations = 0});
  const Reconstruction reconstruction(mesh);
  std::vector<std::uint8_t> open(probes.size());
  tbb::parallel_for(tbb::blocked_range<Index>(0, probes.size(), 128), [&](const auto& range) {
    RecentCells recent(reconstruction);
    for (Index i = range.begin(); i != range.end(); ++i) {
      const Point& probe = probes.points[i];
      if (recent.cover({&probe, 1}, limit)) continue;
      const Reconstruction::Nearest nearest = reconstruction.nearest(probe, limit);
      if (nearest.cell != kNone) recent.add(nearest.cell);
      open[i] = nearest.distance > limit ? 1 : 0;
    }
  });
  const double separation = kSeparation * std::sqrt(surface.report().area / sampling.size());
  PointTree tree(surface.bounding_box());
  for (const Point& point : sampling.points) tree.add(point);
  SurfaceSampling found;
  for (Index i = 0; i < probes.size(); ++i) {
    const Point& place = probes.points[i];
    const auto is_near = [&](const Point& other) { return (other - place).norm() < separation; };
    if (!open[i] || tree.any_within(place, separation, is_near)) continue;
    tree.add(place);
    found.points.push_back(place);
    found.triangles.push_back(probes.triangles[i]);
    found.features.push_back(probes.features[i]);
    found.origins.push_back(PointOrigin::repair);
  }
  return found;
}

}  // namespace orchard::detail
