#include "orchard/geometry/sampling.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "cell_hash.h"
#include "cluster_relaxation.h"
#include "edge_points.h"
#include "neighbor_relaxation.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

using detail::SurfacePoint;

// With fewer points for each cluster, the cluster method is clearly less even than Turk's. With more, it is about as
// good and faster.
constexpr double kFewPointsPerCluster = 32;
constexpr std::uint64_t kPlacement = 0x706c616365;  // stage of the random numbers

// Returns the weights of a uniform random point of a triangle (Turk 1990): a point of the parallelogram, folded over
// the diagonal.
Vector random_weights(Random& random) {
  double s = random.uniform(), t = random.uniform();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  return {1 - s - t, s, t};
}

// Places point k at random in the k-th of `count` equal shares of the area, in the order of the clusters. All places
// are equally likely, and the number of points of a cluster differs from its share by less than one.
std::vector<SurfacePoint> place_at_random(const Surface& surface, const Clusters& clusters, Index count,
                                          std::uint64_t seed) {
  const std::vector<Index>& order = clusters.triangles.items;
  std::vector<double> sums;
  sums.reserve(order.size());
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

// Returns, for each point in order, whether it is kept: whether it is farther than `distance` from all points kept
// before.
std::vector<bool> keep_apart(const Surface& surface, std::span<const Point> points, double distance) {
  if (!(distance > 0)) return std::vector<bool>(points.size(), true);  // the object has no extent
  detail::CellHash grid(surface.bounding_box().min(), 2 * distance);
  std::vector<detail::Cell> cells;
  for (const Point& p : points) cells.push_back(grid.cell_of(p));
  grid.build(cells);
  std::vector<bool> kept(points.size(), true);
  for (Index i = 0; i < points.size(); ++i) {
    const Vector margin = Vector::Constant(1.01 * distance);
    const detail::Cell low = grid.cell_of(points[i] - margin), high = grid.cell_of(points[i] + margin);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          grid.visit({x, y, z}, [&](Index j) {
            if (j < i && kept[j] && (points[j] - points[i]).norm() <= distance) kept[i] = false;
          });
  }
  return kept;
}

SurfaceSampling without_coincident(const Surface& surface, const SurfaceSampling& all) {
  const double distance = tolerance::kCoincidentPoints * surface.bounding_radius();
  const std::vector<bool> kept = keep_apart(surface, all.points, distance);
  SurfaceSampling result;
  for (Index i = 0; i < all.size(); ++i) {
    if (!kept[i]) continue;
    result.points.push_back(all.points[i]);
    result.triangles.push_back(all.triangles[i]);
    result.features.push_back(all.features[i]);
    result.origins.push_back(all.origins[i]);
  }
  return result;
}

Point position(const Surface& surface, const detail::EdgePoint& point) {
  const auto p = surface.corners(point.triangle);
  const auto start = static_cast<std::size_t>(point.edge), end = (start + 1) % 3;
  return p[start] + point.fraction * (p[end] - p[start]);
}

Clusters clusters_for(const Surface& surface, const SamplingOptions& options) {
  if (options.cluster_angle == tolerance::kCoplanarAngle) return surface.clusters();
  std::vector<Vector> normals;
  std::vector<std::array<Index, 3>> neighbors;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    normals.push_back(surface.normal(t));
    neighbors.push_back(surface.neighbors(t));
  }
  return find_clusters(normals, neighbors, options.cluster_angle);
}

double total_area(const Surface& surface) {
  double area = 0;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) area += surface.area(t);
  return area;
}

Relaxation choose(const Clusters& clusters, const SamplingOptions& options) {
  if (options.relaxation != Relaxation::automatic) return options.relaxation;
  if (options.face_points == 0) return Relaxation::clusters;
  const double points_per_cluster = static_cast<double>(options.face_points) / clusters.count();
  return points_per_cluster < kFewPointsPerCluster ? Relaxation::neighbors : Relaxation::clusters;
}

struct Placed {
  std::vector<SurfacePoint> faces;
  std::vector<detail::EdgePoint> edges;
};

Placed sample_clusters(const Surface& surface, const Clusters& clusters, const SamplingOptions& options,
                       const Progress& progress) {
  const auto divided = [&](Index a, Index b) { return clusters.of_triangle[a] != clusters.of_triangle[b]; };
  const detail::EdgePlacement edges = detail::place_edge_points(surface, divided, options.edge_points, 0);
  const double line_density = edges.length > 0 ? static_cast<double>(edges.points.size()) / edges.length : 0;
  Placed placed{place_at_random(surface, clusters, options.face_points, options.seed), edges.points};
  detail::relax_in_clusters(surface, clusters, line_density, options.iterations, placed.faces, progress);
  return placed;
}

Placed sample_by_neighbors(const Surface& surface, const Clusters& clusters, const SamplingOptions& options,
                           const Progress& progress) {
  const double straight = std::cos(options.crease_angle);
  const auto divided = [&](Index a, Index b) { return surface.normal(a).dot(surface.normal(b)) < straight; };
  const double count = static_cast<double>(options.face_points) + options.edge_points;
  const double spacing = std::sqrt(total_area(surface) / count);
  const auto candidates = detail::place_edge_points(surface, divided, options.edge_points, spacing).points;
  // Points of different chains may be close together if chains are shorter than the spacing.
  std::vector<Point> positions;
  positions.reserve(candidates.size());
  for (const detail::EdgePoint& p : candidates) positions.push_back(position(surface, p));
  const std::vector<bool> kept = keep_apart(surface, positions, 0.6 * spacing);
  Placed placed;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    if (kept[i]) placed.edges.push_back(candidates[i]);
  const Index left_over = options.edge_points - static_cast<Index>(placed.edges.size());
  placed.faces = place_at_random(surface, clusters, options.face_points + left_over, options.seed);
  detail::FixedPoints fixed;
  for (const detail::EdgePoint& p : placed.edges) {
    fixed.positions.push_back(position(surface, p));
    fixed.normals.push_back(surface.pseudonormal(p.triangle, static_cast<Feature>(1 + p.edge)));
  }
  detail::relax_by_neighbors(surface, fixed, options.iterations, placed.faces, progress);
  return placed;
}

}  // namespace

Relaxation choose_relaxation(const Surface& surface, const SamplingOptions& options) {
  if (options.relaxation != Relaxation::automatic) return options.relaxation;
  return choose(clusters_for(surface, options), options);
}

SurfaceSampling sample_surface(const Surface& surface, const SamplingOptions& options, const Progress& progress) {
  if (std::uint64_t{options.face_points} + options.edge_points < 4)
    throw InputError("at least four surface points are needed, face and edge points together");
  const Clusters clusters = clusters_for(surface, options);
  const bool by_clusters = choose(clusters, options) == Relaxation::clusters;
  const auto [faces, edges] = by_clusters ? sample_clusters(surface, clusters, options, progress)
                                          : sample_by_neighbors(surface, clusters, options, progress);
  SurfaceSampling all;
  for (const SurfacePoint& p : faces) add_point(surface, position(surface, p), p.triangle, PointOrigin::face, all);
  for (const detail::EdgePoint& p : edges) add_point(surface, position(surface, p), p.triangle, PointOrigin::edge, all);
  return without_coincident(surface, all);
}

void validate(const SurfaceSampling& sampling, const Surface& surface) {
  const std::size_t count = sampling.points.size();
  if (sampling.triangles.size() != count || sampling.features.size() != count || sampling.origins.size() != count)
    throw Error("the arrays of a surface sampling differ in length");
  // Far from the origin, the rounding of coordinates is larger than the tolerance.
  const Box& box = surface.bounding_box();
  const double max = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  const double tolerance = tolerance::kOnTriangle * surface.bounding_radius() + 1e-15 * max;
  for (std::size_t i = 0; i < count; ++i) {
    const auto name = [i] { return "surface point " + std::to_string(i); };
    if (sampling.triangles[i] >= surface.mesh().triangles.size())
      throw Error(name() + " names a triangle that does not exist");
    const auto [a, b, c] = surface.corners(sampling.triangles[i]);
    if (!(closest_point_of_triangle(sampling.points[i], a, b, c).distance <= tolerance))
      throw Error(name() + " is not on its triangle");
  }
}

}  // namespace orchard
