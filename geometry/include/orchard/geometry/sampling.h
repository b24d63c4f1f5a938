#pragma once
#include <cstdint>

#include "orchard/geometry/mesh.h"
#include "orchard/geometry/progress.h"
#include "orchard/geometry/surface.h"

namespace orchard {

enum class PointOrigin : std::uint8_t { face, edge, repair };

// Points on a surface. The four arrays have the same length.
struct SurfaceSampling {
  std::vector<Point> points;          // no two within tolerance::kCoincidentPoints * R
  std::vector<Index> triangles;       // one that the point lies on
  std::vector<Feature> features;      // of that triangle
  std::vector<PointOrigin> origins;   // who put it there

  Index size() const { return static_cast<Index>(points.size()); }
};

struct SamplingOptions {
  Index face_points = 4000;   // spread over the area, relaxed
  Index edge_points = 1000;   // evenly spaced along the edges between clusters
  int iterations = 40;        // of relaxation; Turk's and the dissertation's number
  std::uint64_t seed = 1;
};

// Dissertation 6.2.2: area-weighted random points, relaxed inside each coplanar cluster (points repel linearly within a
// radius, the cluster's boundary edges push inwards, a step ends where it meets the boundary), then evenly spaced points
// on the edges between clusters. Points that would coincide are dropped, so there may be fewer than asked for.
// O(n) per iteration; the same points for a seed whatever the thread count. Throws InputError if fewer than four points
// are asked for.
SurfaceSampling sample_surface(const Surface& surface, const SamplingOptions& options = {},
                               const Progress& progress = {});

// Throws Error if the arrays' lengths differ or a point is farther than tolerance::kOnTriangle * R from its triangle.
void validate(const SurfaceSampling& sampling, const Surface& surface);

}  // namespace orchard
