#include "half_edge_mesh.h"

#include <string>
#include <vector>

#include "orchard/geometry/error.h"

namespace orchard {

HalfEdgeMesh half_edge_mesh(const TriangleMesh& mesh) {
  HalfEdgeMesh result;
  result.reserve(mesh.vertices.size(), 3 * mesh.triangles.size() / 2, mesh.triangles.size());
  for (const Point& p : mesh.vertices) result.add_vertex({p.x(), p.y(), p.z()});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::array<HalfEdgeMesh::VertexHandle, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = HalfEdgeMesh::VertexHandle(static_cast<int>(mesh.triangles[t][i]));
    if (!result.add_face(corners.data(), corners.size()).is_valid()) {
      throw Error("triangle " + std::to_string(t) +
                  " does not fit into an oriented manifold: one of its edges has two triangles already, or one in the "
                  "same direction");
    }
  }
  return result;
}

bool agrees(const HalfEdgeMesh& half_edges, const MeshReport& report) {
  std::int64_t used_vertices = 0;
  for (const auto vertex : half_edges.vertices()) used_vertices += !half_edges.is_isolated(vertex);
  Index boundary_edges = 0;
  for (const auto edge : half_edges.edges()) boundary_edges += half_edges.is_boundary(edge);

  Index components = 0;
  std::vector<bool> reached(half_edges.n_faces(), false);
  std::vector<HalfEdgeMesh::FaceHandle> stack;
  const auto reach = [&](HalfEdgeMesh::FaceHandle face) {
    const auto i = static_cast<std::size_t>(face.idx());
    if (reached[i]) return;
    reached[i] = true;
    stack.push_back(face);
  };
  for (const auto face : half_edges.faces()) {
    components += !reached[static_cast<std::size_t>(face.idx())];
    for (reach(face); !stack.empty();) {
      const HalfEdgeMesh::FaceHandle next = stack.back();
      stack.pop_back();
      for (auto neighbor = half_edges.cff_iter(next); neighbor.is_valid(); ++neighbor) reach(*neighbor);
    }
  }
  const std::int64_t euler =
      used_vertices - static_cast<std::int64_t>(half_edges.n_edges()) + static_cast<std::int64_t>(half_edges.n_faces());
  return boundary_edges == report.boundary_edges && components == report.components &&
         euler == report.euler_characteristic && half_edges.n_faces() == report.triangles &&
         half_edges.n_vertices() == report.vertices;
}

}  // namespace orchard
