#pragma once
#include <cstdint>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"

// Places evenly spread points on a surface, from which the Voronoi diagram and the medial axis are built.
namespace orchard {

// The stage that added a point: sampling of faces, sampling of edges, or gap repair.
enum class PointOrigin : std::uint8_t { face, edge, repair };

// Points on a surface. The four arrays have the same length.
struct SurfaceSampling {
  std::vector<Point> points;         // No two points are within tolerance::kCoincidentPoints * R.
  std::vector<Index> triangles;      // A triangle that the point lies on.
  std::vector<Feature> features;     // The part of that triangle.
  std::vector<PointOrigin> origins;  // The stage that added the point.

  Index size() const { return static_cast<Index>(points.size()); }
};

// The rule by which points repel each other.
//   clusters  Points repel each other within a coplanar cluster, whose edges push inwards (dissertation 6.2.2). Use it
//             for objects with large flat faces.
//   neighbors Points repel each other across faces by Turk's rule (1991). Use it for scanned and curved meshes, where a
//             cluster has very few points.
//   automatic The rule that choose_relaxation() returns.
enum class Relaxation : std::uint8_t { automatic, clusters, neighbors };

// The options of sample_surface().
struct SamplingOptions {
  Index face_points = 4000;  // Points that are spread over the area and relaxed.
  Index edge_points = 1000;  // Points at even spacing along edges, see sample_surface().
  int iterations = 40;       // Steps of relaxation; 40 is Turk's and the dissertation's number.
  std::uint64_t seed = 1;
  Relaxation relaxation = Relaxation::automatic;
  // The largest angle in radians between a triangle of a cluster and the cluster's first triangle. Larger values give
  // curved clusters.
  double cluster_angle = tolerance::kCoplanarAngle;
  // The angle in radians above which an edge of a surface without clusters counts as a crease.
  double crease_angle = 0.5;
};

// Returns the rule that `automatic` stands for: clusters if they get at least 32 face points on average or if there are
// no face points, otherwise neighbors.
Relaxation choose_relaxation(const Surface& surface, const SamplingOptions& options);

// Places points on a surface: random points with a density uniform in area, which are then relaxed, and evenly spaced
// points on edges.
// - Clusters: the points of a cluster repel each other linearly, its boundary edges push them inwards, and a step ends
//   where it meets the boundary. Edge points lie on the edges between clusters.
// - Neighbors: points repel each other across faces, and edge points repel them too. Edge points lie on creases and
//   boundaries, at least half the mean spacing apart; the remaining ones become face points.
// Points that would coincide are dropped, so the result may have fewer points than requested. It is the same for a seed
// on any number of threads. Throws InputError if fewer than four points are requested. O(n) per iteration. Source:
// dissertation 6.2.2.
SurfaceSampling sample_surface(const Surface& surface, const SamplingOptions& options = {},
                               const Progress& progress = {});

// How evenly points are spread, measured by the distance from each point to the nearest other point on the same side
// of the solid.
struct Evenness {
  double mean = 0;       // The mean distance; the best possible is near sqrt(2 / sqrt(3) * area / points).
  double min = 0;        // The smallest distance over the mean; 1 is perfect, a random spread has nearly 0.
  double variation = 0;  // Standard deviation over the mean; 0 is perfect, a random spread has 0.52.
};
// Measures how evenly points are spread. All members are 0 if there are fewer than two points. O(n).
Evenness evenness(const SurfaceSampling& sampling, const Surface& surface);

// Throws Error if the arrays' lengths differ or if a point is farther than tolerance::kOnTriangle * R from its
// triangle.
void validate(const SurfaceSampling& sampling, const Surface& surface);

}  // namespace orchard
