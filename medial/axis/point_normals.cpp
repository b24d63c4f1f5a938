#include "point_normals.h"

#include <algorithm>

#include "orchard/geometry/angle.h"

namespace orchard::detail {

void add_points(const Surface& surface, const SurfaceSampling& sampling, MedialAxis& axis) {
  axis.points = sampling.points;
  axis.origins = sampling.origins;
  std::vector<Index> around;
  for (Index i = 0; i < sampling.size(); ++i) {
    const Vector normal = surface.pseudonormal(sampling.triangles[i], sampling.features[i]);
    surface.triangles_at(sampling.triangles[i], sampling.features[i], around);
    double turn = 0;
    for (const Index triangle : around) {
      const Vector& own = surface.normal(triangle);
      turn = std::max(turn, angle_between(normal, own));
    }
    axis.normals.push_back(normal);
    axis.turns.push_back(turn);
  }
}

}  // namespace orchard::detail
