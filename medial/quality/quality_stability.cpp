#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "orchard/geometry/error.h"
#include "orchard/medial/quality.h"
#include "smooth_noise.h"

namespace orchard {
namespace {

// Radians, 10 degrees: a part whose angle is only this much below the threshold does not count as lost.
constexpr double kHysteresis = 0.1745;

// Over the spacing of the noise's lattice: edges of at most this length reproduce the noise.
constexpr double kMaxEdge = 0.5;

// Finds the triangles of points that lie on the same surface with other triangles.
void find_again(const Surface& surface, SurfaceSampling& points) {
  tbb::parallel_for(Index{0}, points.size(), [&](Index i) {
    const ClosestPoint closest = surface.closest(points.points[i]);
    points.triangles[i] = closest.triangle;
    points.features[i] = closest.feature;
  });
}

TriangleMesh moved_by(const detail::SmoothNoise& noise, double max, TriangleMesh mesh) {
  tbb::parallel_for(std::size_t{0}, mesh.vertices.size(), [&](std::size_t i) {
    const Point place = mesh.vertices[i];
    mesh.vertices[i] = place + max * noise(place);
  });
  return mesh;
}

// Returns the points moved along with the mesh.
SurfaceSampling carried_along(SurfaceSampling sampling, const Surface& from, const Surface& to) {
  for (Index i = 0; i < sampling.size(); ++i) {
    const auto [a, b, c] = from.corners(sampling.triangles[i]);
    const auto [p, q, r] = to.corners(sampling.triangles[i]);
    const Vector u = b - a, v = c - a, normal = u.cross(v), place = sampling.points[i] - a;
    const double beta = v.cross(normal).dot(place) / normal.squaredNorm();
    const double gamma = normal.cross(u).dot(place) / normal.squaredNorm();
    sampling.points[i] = p + beta * (q - p) + gamma * (r - p);
  }
  return sampling;
}

struct WidePart {
  std::vector<Point> points;  // vertices with a wide enough angle
  // The part of the axis with an angle slightly below the threshold or wider, with degenerate triangles for edges and
  // vertices.
  TriangleMesh sheets;
};

// Cuts the axis where its angle, which is linear between vertices, equals the threshold. Cells may be long, so a cell
// is not dropped as a whole because one corner is beyond the threshold.
class SheetCutter {
 public:
  SheetCutter(const MedialAxis& axis, const std::vector<double>& angles, double min)
      : axis_(axis), angles_(angles), min_(min) {
    sheets_.vertices = axis.centers;
  }

  TriangleMesh run() {
    for (Index i = 0; i < axis_.size(); ++i) {
      if (wide(i)) sheets_.triangles.push_back({i, i, i});
      for (const Index next : axis_.neighbors[i]) {
        if (next > i) cut_edge(i, next);
      }
    }
    for (Index face = 0; face < axis_.faces.size(); ++face) cut_face(axis_.faces[face]);
    return std::move(sheets_);
  }

 private:
  bool wide(Index vertex) const { return angles_[vertex] > min_; }

  // Adds the place between a wide and a narrow vertex where the angle equals the threshold.
  Index crossing(Index a, Index b) {
    const double t = (min_ - angles_[a]) / (angles_[b] - angles_[a]);
    sheets_.vertices.push_back(axis_.centers[a] + t * (axis_.centers[b] - axis_.centers[a]));
    return static_cast<Index>(sheets_.vertices.size()) - 1;
  }
  void cut_edge(Index a, Index b) {
    if (!wide(a)) std::swap(a, b);
    if (!wide(a)) return;
    const Index end = wide(b) ? b : crossing(a, b);
    sheets_.triangles.push_back({a, end, end});
  }
  void cut_face(std::span<const Index> corners) {
    std::vector<Index> left;
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const Index corner = corners[k], next = corners[(k + 1) % corners.size()];
      if (wide(corner)) left.push_back(corner);
      if (wide(corner) != wide(next)) left.push_back(crossing(corner, next));
    }
    for (std::size_t k = 1; k + 1 < left.size(); ++k) sheets_.triangles.push_back({left[0], left[k], left[k + 1]});
  }

  const MedialAxis& axis_;
  const std::vector<double>& angles_;
  const double min_;
  TriangleMesh sheets_;
};

WidePart wide_part(const MedialAxis& axis, double angle) {
  const std::vector<double> angles = contact_angles(axis);
  WidePart part{.points = {}, .sheets = SheetCutter(axis, angles, angle - 2 * kHysteresis).run()};
  for (Index i = 0; i < axis.size(); ++i) {
    if (angles[i] > angle) part.points.push_back(axis.centers[i]);
  }
  return part;
}

void add_distances(const std::vector<Point>& points, const TriangleMesh& sheets, std::vector<double>& all) {
  const Surface surface(sheets);
  const std::size_t first = all.size();
  all.resize(first + points.size());
  tbb::parallel_for(std::size_t{0}, points.size(),
                    [&](std::size_t i) { all[first + i] = surface.distance(points[i]); });
}

MedialStability summary(std::vector<double> distances, double noise) {
  std::sort(distances.begin(), distances.end());
  MedialStability result{.hausdorff = distances.back() / noise,
                         .percentile99 = distances[(distances.size() - 1) * 99 / 100] / noise};
  for (const double distance : distances) result.mean += distance / noise / static_cast<double>(distances.size());
  return result;
}

}  // namespace

std::optional<MedialStability> medial_stability(const Surface& surface, const MedialBuild& build,
                                                const MedialBuildOptions& options, const StabilityOptions& stability,
                                                const Progress& progress) {
  if (!(stability.correlation > 0))
    throw InputError("the correlation length of the noise for stability must be above 0");
  const double diagonal = surface.bounding_box().diagonal().norm();
  const double noise = stability.noise * diagonal, correlation = stability.correlation * diagonal;
  TriangleMesh mesh = detail::with_short_edges(surface.mesh(), kMaxEdge * correlation);
  SurfaceSampling sampling = build.sampling;
  std::optional<Surface> divided;
  if (mesh.triangles.size() > surface.mesh().triangles.size()) {
    find_again(divided.emplace(mesh), sampling);
  }
  const Surface moved(moved_by({surface.bounding_box(), correlation, stability.seed}, noise, std::move(mesh)));
  if (!moved.solid()) return std::nullopt;
  MedialBuildInput points;
  points.sampling = carried_along(std::move(sampling), divided ? *divided : surface, moved);
  MedialBuildOptions unchecked = options;
  unchecked.check_promise = false;
  const MedialBuild other = build_medial_axis(moved, unchecked, progress, std::move(points));
  const WidePart a = wide_part(build.axis, 2 * stability.object_angle);
  const WidePart b = wide_part(other.axis, 2 * stability.object_angle);
  if (a.points.empty() || b.points.empty()) return std::nullopt;
  std::vector<double> distances;
  add_distances(a.points, b.sheets, distances);
  add_distances(b.points, a.sheets, distances);
  return summary(std::move(distances), noise);
}

}  // namespace orchard
