#pragma once
#include <algorithm>

#include "orchard/medial/build.h"
#include "orchard/medial/curve_skeleton.h"

// What the tests of curve skeletons share.
namespace orchard::test {

inline double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + t * (b - a))).norm();
}

inline Topology topology_of(const CurveSkeleton& skeleton) { return topology(medial_mesh(skeleton)); }

// The refined axis of a solid from so many surface points, a fifth of them along edges.
inline MedialMesh refined_axis(const Surface& surface, Index points = 2000) {
  MedialBuildOptions options{.refine = RefineOptions{}, .check_promise = false};
  options.sampling.face_points = points - points / 5;
  options.sampling.edge_points = points / 5;
  return medial_mesh(build_medial_axis(surface, options).axis);
}

}  // namespace orchard::test
