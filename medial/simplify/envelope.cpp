#include "orchard/medial/envelope.h"

#include <string>

#include "../quality/reconstruction.h"
#include "level_set.h"
#include "orchard/geometry/error.h"

namespace orchard {

EnvelopeMesh envelope_mesh(const MedialMesh& mesh, const EnvelopeOptions& options, const Progress& progress) {
  validate(mesh);
  if (!(options.cell >= 1e-4 && options.cell <= 0.5))
    throw InputError("the cells of the envelope must be between 0.0001 and 0.5 diagonals");
  Box box;
  for (Index v = 0; v < mesh.size(); ++v) {
    box.extend(mesh.centers[v] + Vector::Constant(mesh.radii[v]));
    box.extend(mesh.centers[v] - Vector::Constant(mesh.radii[v]));
  }
  const double cell = options.cell * box.diagonal().norm();
  EnvelopeMesh result;
  if (cell > 0) {
    const detail::Reconstruction reconstruction(mesh);
    detail::LevelSet level([&](const Point& place) { return reconstruction.distance(place); }, box, cell, progress,
                           "meshing the envelope");
    result.mesh = level.mesh();
    for (Index v = 0; v < mesh.size(); ++v) result.lost += mesh.radii[v] > 0 && level.lost_at(mesh.centers[v]) ? 1 : 0;
  }
  if (result.mesh.triangles.empty())
    throw InputError("the envelope is everywhere thinner than its cells of " + std::to_string(100 * options.cell) +
                     " % of the diagonal; take smaller ones");
  return result;
}

}  // namespace orchard
