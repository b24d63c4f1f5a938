#include "orchard/geometry/mesh_details.h"

#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "same_place.h"

namespace orchard {
namespace {

// The number of independent cycles of a graph: edges - vertices + components.
Index count_boundary_loops(const TriangleMesh& mesh) {
  DisjointSets components(mesh.vertices.size());
  std::vector<bool> on_boundary(mesh.vertices.size(), false);
  Index edges = 0, vertices = 0, roots = 0;
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    if (edge.size() != 1) return;
    ++edges;
    on_boundary[edge[0].low] = on_boundary[edge[0].high] = true;
    components.unite(edge[0].low, edge[0].high);
  });
  for (Index v = 0; v < on_boundary.size(); ++v) {
    if (!on_boundary[v]) continue;
    ++vertices;
    roots += components.root(v) == v ? 1 : 0;
  }
  return edges + roots - vertices;
}

}  // namespace

MeshDetails mesh_details(const TriangleMesh& mesh, const MeshReport& report) {
  MeshDetails details;
  details.boundary_loops = count_boundary_loops(mesh);
  const std::vector<Index> first = first_at_place(mesh);
  for (Index v = 0; v < first.size(); ++v) details.coincident_vertices += first[v] != v ? 1 : 0;
  TriangleMesh welded{{}, mesh.triangles};
  for (auto& corners : welded.triangles)
    for (Index& vertex : corners) vertex = first[vertex];
  for (const auto& group : same_corners(welded)) details.duplicate_triangles += static_cast<Index>(group.size() - 1);
  if (report.closed() && report.manifold() && report.misoriented_edges == 0 && report.degenerate_triangles == 0)
    details.genus = static_cast<std::int64_t>(report.components) - report.euler_characteristic / 2;
  return details;
}

}  // namespace orchard
