#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <vector>

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/wrap.h"

namespace orchard {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using WrapMesh = CGAL::Surface_mesh<Kernel::Point_3>;

void require_fraction(double value, const char* name) {
  if (!(value > 0 && value < 1))
    throw InputError(std::string("the ") + name + " of a wrap is a fraction of the diagonal, between 0 and 1");
}

TriangleMesh to_mesh(const WrapMesh& wrap) {
  TriangleMesh mesh;
  std::vector<Index> number(wrap.number_of_vertices() + wrap.number_of_removed_vertices(), kNone);
  for (const auto vertex : wrap.vertices()) {
    number[vertex.idx()] = static_cast<Index>(mesh.vertices.size());
    const auto& p = wrap.point(vertex);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : wrap.faces()) {
    auto& corners = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const auto vertex : wrap.vertices_around_face(wrap.halfedge(face))) corners.at(i++) = number[vertex.idx()];
  }
  return mesh;
}

}  // namespace

TriangleMesh wrap_mesh(const TriangleMesh& mesh, const WrapOptions& options) {
  validate(mesh);
  require_fraction(options.alpha, "alpha");
  require_fraction(options.offset, "offset");
  std::vector<Kernel::Point_3> points;
  for (const Point& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::array<std::size_t, 3>> faces;
  Box box;
  for (const auto& [i, j, k] : mesh.triangles) {
    for (const Index vertex : {i, j, k}) box.extend(mesh.vertices[vertex]);
    faces.push_back({i, j, k});
  }
  const double diagonal = box.diagonal().norm();
  if (!(diagonal > 0)) throw InputError("all of the mesh lies in one point");
  WrapMesh wrap;
  CGAL::alpha_wrap_3(points, faces, options.alpha * diagonal, options.offset * diagonal, wrap);
  TriangleMesh result = to_mesh(wrap);
  require_solid(result);
  return result;
}

}  // namespace orchard
