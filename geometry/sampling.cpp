#include "orchard/geometry/sampling.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cell_hash.h"
#include "cluster_relaxation.h"
#include "edge_points.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

using detail::SurfacePoint;

constexpr std::uint64_t kPlacement = 0x706c616365;  // stage of the random numbers

// Turk's (1990) uniform point of a triangle: a point of the parallelogram, folded over the diagonal.
Vector random_weights(Random& random) {
  double s = random.uniform(), t = random.uniform();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  return {1 - s - t, s, t};
}

// Point k takes a random place in the k-th of `count` equal shares of the area, in the order of the clusters. Every
// place is as likely as any other, and a cluster's number of points differs from its share by less than one.
std::vector<SurfacePoint> place_at_random(const Surface& surface, const Clusters& clusters, Index count,
                                          std::uint64_t seed) {
  const std::vector<Index>& order = clusters.triangles.items;
  std::vector<double> sums;
  double total = 0;
  for (const Index t : order) sums.push_back(total += surface.area(t));
  std::vector<SurfacePoint> points(total > 0 ? count : 0);
  for (Index k = 0; k < points.size(); ++k) {
    Random random(seed, kPlacement, k);
    const double target = total * ((k + random.uniform()) / count);
    auto at = std::upper_bound(sums.begin(), sums.end(), target);
    if (at == sums.end()) at = std::lower_bound(sums.begin(), sums.end(), total);
    points[k] = {order[static_cast<std::size_t>(at - sums.begin())], random_weights(random)};
  }
  return points;
}

void add_point(const Surface& surface, const Point& point, Index triangle, PointOrigin origin, SurfaceSampling& out) {
  const auto [a, b, c] = surface.corners(triangle);
  out.points.push_back(point);
  out.triangles.push_back(triangle);
  out.features.push_back(closest_point_of_triangle(point, a, b, c).feature);
  out.origins.push_back(origin);
}

// Keeps the first of points that lie within the tolerance of each other.
SurfaceSampling without_coincident(const Surface& surface, const SurfaceSampling& all) {
  const double tolerance = tolerance::kCoincidentPoints * surface.bounding_radius();
  // Cells are wide beside the tolerance, so that hardly any point has to look into more than its own.
  const detail::CellHash layout(surface.bounding_box().min(), 64 * tolerance);
  std::vector<detail::Cell> cells;
  for (const Point& p : all.points) cells.push_back(layout.cell_of(p));
  detail::CellHash grid = layout;
  grid.build(cells);
  SurfaceSampling kept;
  std::vector<bool> dropped(all.size(), false);
  for (Index i = 0; i < all.size(); ++i) {
    const Vector margin = Vector::Constant(2 * tolerance);
    const detail::Cell low = layout.cell_of(all.points[i] - margin), high = layout.cell_of(all.points[i] + margin);
    for (int z = low[2]; z <= high[2]; ++z)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int x = low[0]; x <= high[0]; ++x)
          grid.visit({x, y, z}, [&](Index j) {
            if (j < i && !dropped[j] && (all.points[j] - all.points[i]).norm() <= tolerance) dropped[i] = true;
          });
    if (dropped[i]) continue;
    kept.points.push_back(all.points[i]);
    kept.triangles.push_back(all.triangles[i]);
    kept.features.push_back(all.features[i]);
    kept.origins.push_back(all.origins[i]);
  }
  return kept;
}

}  // namespace

SurfaceSampling sample_surface(const Surface& surface, const SamplingOptions& options, const Progress& progress) {
  if (std::uint64_t{options.face_points} + options.edge_points < 4)
    throw InputError("at least four surface points are needed, face and edge points together");
  const Clusters& clusters = surface.clusters();
  const detail::EdgePlacement edges = detail::place_edge_points(surface, clusters, options.edge_points);
  const double line_density = edges.length > 0 ? static_cast<double>(edges.points.size()) / edges.length : 0;
  std::vector<SurfacePoint> face_points = place_at_random(surface, clusters, options.face_points, options.seed);
  detail::relax_in_clusters(surface, clusters, line_density, options.iterations, face_points, progress);

  SurfaceSampling all;
  for (const SurfacePoint& p : face_points)
    add_point(surface, position(surface, p), p.triangle, PointOrigin::face, all);
  for (const auto& [triangle, edge, fraction] : edges.points) {
    const auto p = surface.corners(triangle);
    const auto start = static_cast<std::size_t>(edge), end = (start + 1) % 3;
    add_point(surface, p[start] + fraction * (p[end] - p[start]), triangle, PointOrigin::edge, all);
  }
  return without_coincident(surface, all);
}

void validate(const SurfaceSampling& sampling, const Surface& surface) {
  const std::size_t count = sampling.points.size();
  if (sampling.triangles.size() != count || sampling.features.size() != count || sampling.origins.size() != count)
    throw Error("a surface sampling's arrays differ in length");
  // Far from the origin the rounding of the coordinates themselves is larger than the tolerance.
  const Box& box = surface.bounding_box();
  const double largest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double tolerance = tolerance::kOnTriangle * surface.bounding_radius() + 1e-15 * largest;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string name = "surface point " + std::to_string(i);
    if (sampling.triangles[i] >= surface.mesh().triangles.size()) throw Error(name + " names no triangle");
    const auto [a, b, c] = surface.corners(sampling.triangles[i]);
    if (!(closest_point_of_triangle(sampling.points[i], a, b, c).distance <= tolerance))
      throw Error(name + " is not on its triangle");
  }
}

}  // namespace orchard
