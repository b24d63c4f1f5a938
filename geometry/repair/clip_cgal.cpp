#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/clip.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cgal_mesh.h"
#include "orchard/geometry/clip.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_check.h"

namespace orchard {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;

detail::CgalMesh to_cgal(const TriangleMesh& mesh) {
  detail::CgalMesh result;
  std::vector<detail::CgalMesh::Vertex_index> vertices;
  for (const Point& p : mesh.vertices) vertices.push_back(result.add_vertex({p.x(), p.y(), p.z()}));
  for (const auto& [a, b, c] : mesh.triangles)
    if (result.add_face(vertices[a], vertices[b], vertices[c]) == detail::CgalMesh::null_face())
      throw InputError("a plane can only cut a solid whose surface is manifold; repair the mesh first");
  return result;
}

}  // namespace

TriangleMesh clip_solid(TriangleMesh mesh, const HalfSpace& kept) {
  require_solid(mesh);
  if (!kept.normal.allFinite() || !std::isfinite(kept.offset) || kept.normal.isZero(0))
    throw InputError("a plane needs a finite normal other than zero, and a finite offset");
  const auto lies_out = [&](const Point& p) { return kept.normal.dot(p) < kept.offset; };
  const auto out = std::count_if(mesh.vertices.begin(), mesh.vertices.end(), lies_out);
  if (out == 0) return mesh;
  if (static_cast<std::size_t>(out) == mesh.vertices.size())
    throw InputError("nothing of the solid lies on the side of the plane that is to be kept");
  detail::CgalMesh part = to_cgal(mesh);
  // CGAL keeps the side that the plane's normal points away from.
  const detail::CgalKernel::Plane_3 plane(-kept.normal.x(), -kept.normal.y(), -kept.normal.z(), kept.offset);
  try {
    processing::clip(part, plane, CGAL::parameters::clip_volume(true).throw_on_self_intersection(true));
  } catch (const processing::Corefinement::Self_intersection_exception&) {
    throw InputError("the mesh cuts itself where the plane does, so that no part of it can be closed; --wrap it first");
  }
  TriangleMesh result = detail::from_cgal(part);
  require_solid(result);
  return result;
}

}  // namespace orchard
