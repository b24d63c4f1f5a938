#pragma once
#include <cstdint>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {

enum class PointOrigin : std::uint8_t { face, edge, repair };

// Points on a surface. The four arrays have the same length.
struct SurfaceSampling {
  std::vector<Point> points;         // no two within tolerance::kCoincidentPoints * R
  std::vector<Index> triangles;      // one that the point lies on
  std::vector<Feature> features;     // of that triangle
  std::vector<PointOrigin> origins;  // who put it there

  Index size() const { return static_cast<Index>(points.size()); }
};

// How points keep apart. clusters: inside each coplanar cluster, whose edges push inwards (dissertation 6.2.2); right
// for objects made of large flat faces. neighbors: across faces by Turk's rule (1991); right for scanned and curved
// meshes, where a cluster has hardly any points. automatic: see choose_relaxation.
enum class Relaxation : std::uint8_t { automatic, clusters, neighbors };

struct SamplingOptions {
  Index face_points = 4000;  // spread over the area, relaxed
  Index edge_points = 1000;  // evenly spaced along edges, see sample_surface
  int iterations = 40;       // of relaxation; Turk's and the dissertation's number
  std::uint64_t seed = 1;
  Relaxation relaxation = Relaxation::automatic;
  double cluster_angle = tolerance::kCoplanarAngle;  // radians from a cluster's first triangle; > 0 for curved clusters
  double crease_angle = 0.5;  // radians; where a surface without clusters turns by more is an edge
};

// What `automatic` stands for: clusters if they get 32 face points or more on average, or if there are no face points.
Relaxation choose_relaxation(const Surface& surface, const SamplingOptions& options);

// Dissertation 6.2.2: area-weighted random points, relaxed, then evenly spaced points on edges.
// Clusters: the points of a cluster repel each other linearly, its boundary edges push inwards, a step ends where it
// meets the boundary. Edge points lie on the edges between clusters. Neighbors: points repel each other across faces,
// and edge points repel them too. Edge points lie on creases and boundaries, no closer to each other than half the mean
// spacing; those left over become face points. Points that would coincide are dropped, so there may be fewer than asked
// for. O(n) per iteration; the same points for a seed whatever the thread count. Throws InputError if fewer than four
// points are asked for.
SurfaceSampling sample_surface(const Surface& surface, const SamplingOptions& options = {},
                               const Progress& progress = {});

// How evenly points are spread, by the distance from each to the nearest other one on the same sheet of the surface.
struct Evenness {
  double mean = 0;       // of the distances; the best possible is near sqrt(2 / sqrt(3) * area / points)
  double min = 0;        // over the mean; 1 is perfect, a random spread has nearly 0
  double variation = 0;  // standard deviation over the mean; 0 is perfect, a random spread has 0.52
};
Evenness evenness(const SurfaceSampling& sampling, const Surface& surface);  // O(n); zeros below two points

// Throws Error if the arrays' lengths differ or a point is farther than tolerance::kOnTriangle * R from its triangle.
void validate(const SurfaceSampling& sampling, const Surface& surface);

}  // namespace orchard
