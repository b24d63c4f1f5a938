#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <vector>

#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/self_intersections.h"
#include "orchard/geometry/unite.h"

namespace orchard {
namespace {

namespace processing = CGAL::Polygon_mesh_processing;
using ExactKernel = CGAL::Exact_predicates_exact_constructions_kernel;
using ExactMesh = CGAL::Surface_mesh<ExactKernel::Point_3>;

struct VertexComponent {
  std::vector<Index> triangles;  // triangles of the whole mesh, ascending
  Box box;
  double volume = 0;  // times six; negative for a cavity
};

// Returns the parts that no vertex joins, in the order of their first triangles.
std::vector<VertexComponent> vertex_components(const TriangleMesh& mesh) {
  DisjointSets sets(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) sets.unite(a, b), sets.unite(a, c);
  std::vector<VertexComponent> parts;
  std::vector<Index> number(mesh.vertices.size(), kNone);
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    Index& at = number[sets.root(a)];
    if (at == kNone) {
      at = static_cast<Index>(parts.size());
      parts.emplace_back();
    }
    VertexComponent& part = parts[at];
    part.triangles.push_back(t);
    for (const Index v : {a, b, c}) part.box.extend(mesh.vertices[v]);
    const Point& origin = mesh.vertices[mesh.triangles[part.triangles.front()][0]];
    part.volume += (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
  }
  return parts;
}

// Returns for each part the lowest part of its group. A group consists of parts whose triangles meet, directly or
// through others.
std::vector<Index> groups_of(const std::vector<VertexComponent>& parts, const std::vector<std::array<Index, 2>>& cuts,
                             std::size_t triangles) {
  std::vector<Index> part_of(triangles);
  for (Index p = 0; p < parts.size(); ++p)
    for (const Index t : parts[p].triangles) part_of[t] = p;
  DisjointSets groups(parts.size());
  for (const auto& [a, b] : cuts) groups.unite(part_of[a], part_of[b]);
  std::vector<Index> roots(parts.size());
  for (Index p = 0; p < parts.size(); ++p) roots[p] = groups.root(p);
  return roots;
}

ExactMesh to_exact(const TriangleMesh& mesh, const VertexComponent& part) {
  ExactMesh result;
  std::vector<ExactMesh::Vertex_index> vertices(mesh.vertices.size());
  for (const Index t : part.triangles) {
    std::array<ExactMesh::Vertex_index, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = mesh.triangles[t][i];
      const Point& p = mesh.vertices[v];
      if (!vertices[v].is_valid()) vertices[v] = result.add_vertex({p.x(), p.y(), p.z()});
      corners[i] = vertices[v];
    }
    result.add_face(corners[0], corners[1], corners[2]);
  }
  return result;
}

void append(const ExactMesh& from, TriangleMesh& to) {
  std::vector<Index> number(from.number_of_vertices() + from.number_of_removed_vertices(), kNone);
  for (const auto vertex : from.vertices()) {
    number[vertex.idx()] = static_cast<Index>(to.vertices.size());
    const auto& p = from.point(vertex);
    to.vertices.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
  }
  for (const auto face : from.faces()) {
    auto& corners = to.triangles.emplace_back();
    std::size_t i = 0;
    for (const auto vertex : from.vertices_around_face(from.halfedge(face))) corners.at(i++) = number[vertex.idx()];
  }
}

// Adds the union of the parts of one group. Returns false if the union is no manifold.
bool append_union(const TriangleMesh& mesh, const std::vector<const VertexComponent*>& group, TriangleMesh& to) {
  ExactMesh whole = to_exact(mesh, *group.front());
  for (std::size_t p = 1; p < group.size(); ++p) {
    ExactMesh part = to_exact(mesh, *group[p]), both;
    try {
      if (!processing::corefine_and_compute_union(whole, part, both,
                                                  CGAL::parameters::throw_on_self_intersection(true)))
        return false;
    } catch (const processing::Corefinement::Self_intersection_exception&) {
      return false;
    }
    whole = std::move(both);
  }
  append(whole, to);
  return true;
}

void append_part(const TriangleMesh& mesh, const VertexComponent& part, TriangleMesh& to) {
  std::vector<Index> number(mesh.vertices.size(), kNone);
  for (const Index t : part.triangles) {
    auto& corners = to.triangles.emplace_back(mesh.triangles[t]);
    for (Index& corner : corners) {
      Index& at = number[corner];
      if (at == kNone) {
        at = static_cast<Index>(to.vertices.size());
        to.vertices.push_back(mesh.vertices[corner]);
      }
      corner = at;
    }
  }
}

}  // namespace

std::optional<UnitedMesh> unite_parts(const TriangleMesh& mesh, const Progress& progress) {
  TriangleMesh solid = mesh;
  require_solid(solid);
  const std::vector<std::array<Index, 2>> cuts = self_intersections(solid);
  if (cuts.empty()) return std::nullopt;
  const std::vector<VertexComponent> parts = vertex_components(solid);
  const std::vector<Index> groups = groups_of(parts, cuts, solid.triangles.size());
  UnitedMesh result;
  for (Index root = 0; root < parts.size(); ++root) {
    report_progress(progress, "union of parts", root / static_cast<double>(parts.size()));
    if (groups[root] != root) continue;
    std::vector<const VertexComponent*> group;
    for (Index p = root; p < parts.size(); ++p)
      if (groups[p] == root) group.push_back(&parts[p]);
    if (group.size() == 1) {
      append_part(solid, *group.front(), result.mesh);
      continue;
    }
    const bool cavity = std::ranges::any_of(group, [](const VertexComponent* part) { return part->volume < 0; });
    if (cavity || !append_union(solid, group, result.mesh)) return std::nullopt;
    result.parts += static_cast<Index>(group.size());
  }
  if (result.parts == 0 || !repair_mesh(result.mesh).solid) return std::nullopt;
  result.cut_before = static_cast<Index>(cuts.size());
  result.cut_left = static_cast<Index>(self_intersections(result.mesh).size());
  if (result.cut_left >= result.cut_before) return std::nullopt;
  return result;
}

}  // namespace orchard
