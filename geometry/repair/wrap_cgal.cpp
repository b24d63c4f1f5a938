#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <vector>

#include "cgal_mesh.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/wrap.h"

namespace orchard {
namespace {

void require_fraction(double value, const char* name) {
  if (!(value > 0 && value < 1))
    throw InputError(std::string("the ") + name + " of a wrap must be a fraction of the diagonal, above 0 and below 1");
}

}  // namespace

TriangleMesh wrap_mesh(const TriangleMesh& mesh, const WrapOptions& options) {
  validate(mesh);
  require_fraction(options.alpha, "alpha");
  require_fraction(options.offset, "offset");
  std::vector<detail::CgalKernel::Point_3> points;
  for (const Point& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  Box box;
  for (const auto& [i, j, k] : mesh.triangles) {
    for (const Index vertex : {i, j, k}) box.extend(mesh.vertices[vertex]);
    faces.push_back({i, j, k});
  }
  const double diagonal = box.diagonal().norm();
  if (!(diagonal > 0)) throw InputError("the whole mesh lies in one point; there is nothing to wrap");
  detail::CgalMesh wrap;
  CGAL::alpha_wrap_3(points, faces, options.alpha * diagonal, options.offset * diagonal, wrap);
  TriangleMesh result = detail::from_cgal(wrap);
  require_solid(result);
  return result;
}

}  // namespace orchard
