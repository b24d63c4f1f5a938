#pragma once
#include <CGAL/Surface_mesh.h>

#include <vector>

#include "inexact_kernel.h"
#include "orchard/geometry/mesh.h"

namespace orchard::detail {

using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

// Returns the triangles of a mesh of CGAL without those that it has removed.
inline TriangleMesh from_cgal(const CgalMesh& from) {
  TriangleMesh mesh;
  std::vector<Index> number(from.number_of_vertices() + from.number_of_removed_vertices(), kNone);
  for (const auto vertex : from.vertices()) {
    number[vertex.idx()] = static_cast<Index>(mesh.vertices.size());
    const auto& p = from.point(vertex);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  for (const auto face : from.faces()) {
    auto& corners = mesh.triangles.emplace_back();
    std::size_t i = 0;
    for (const auto vertex : from.vertices_around_face(from.halfedge(face))) corners.at(i++) = number[vertex.idx()];
  }
  return mesh;
}

}  // namespace orchard::detail
