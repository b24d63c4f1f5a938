#include "shrunk_spheres.h"

#include <algorithm>
#include <limits>

namespace orchard::construction_methods {

std::vector<ShrunkSphere> shrunk_spheres(const Surface& surface, const SurfaceSampling& sampling,
                                         std::span<const Index> anchors) {
  std::vector<ShrunkSphere> result;
  for (const Index anchor : anchors) {
    const Point& p = sampling.points[anchor];
    const Vector inward = -surface.pseudonormal(sampling.triangles[anchor], sampling.features[anchor]);
    ShrunkSphere shrunk{{p, surface.bounding_radius()}, anchor};
    double& radius = shrunk.sphere.radius;
    for (Index q = 0; q < sampling.size(); ++q) {
      const Vector apart = sampling.points[q] - p;
      const double square = apart.squaredNorm(), depth = apart.dot(inward);
      if (!(square < 2 * radius * depth)) continue;  // outside of the sphere around p + radius * inward
      radius = square / (2 * depth);
      shrunk.stop = q;
      ++shrunk.steps;
    }
    shrunk.sphere.center = p + radius * inward;
    result.push_back(shrunk);
  }
  return result;
}

std::vector<Index> spread_anchors(const SurfaceSampling& sampling, Index count) {
  std::vector<Index> anchors;
  std::vector<double> nearest(sampling.size(), std::numeric_limits<double>::infinity());
  for (Index next = 0; anchors.size() < std::min(count, sampling.size());) {
    anchors.push_back(next);
    for (Index i = 0; i < sampling.size(); ++i)
      nearest[i] = std::min(nearest[i], (sampling.points[i] - sampling.points[next]).squaredNorm());
    next = static_cast<Index>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  return anchors;
}

}  // namespace orchard::construction_methods
