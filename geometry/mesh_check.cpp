#include "orchard/geometry/mesh_check.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "area_vector.h"
#include "half_edge_mesh.h"
#include "half_edges.h"
#include "orchard/geometry/disjoint_sets.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"

namespace orchard {
namespace {

bool repeats_a_corner(const std::array<Index, 3>& corners) {
  return corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
}

// Counts an edge of one kind and keeps the one whose first half-edge comes first in the file.
class EdgeTally {
 public:
  EdgeTally(const TriangleMesh& mesh, Index& count, std::array<Index, 2>& first)
      : mesh_(mesh), count_(count), first_(first) {}
  void add(std::span<const EdgeUse> edge) {
    ++count_;
    const Index half_edge = edge.front().half_edge;
    if (half_edge >= lowest_) return;
    lowest_ = half_edge;
    const auto& corners = mesh_.triangles[half_edge / 3];
    first_ = {corners[half_edge % 3], corners[(half_edge + 1) % 3]};
  }

 private:
  const TriangleMesh& mesh_;
  Index& count_;
  std::array<Index, 2>& first_;
  Index lowest_ = kNone;
};

// Counts edges, fans and components. Returns for each triangle the first triangle of its component.
std::vector<Index> check_connectivity(const TriangleMesh& mesh, MeshReport& report) {
  const auto start = [&](Index half_edge) { return mesh.triangles[half_edge / 3][half_edge % 3]; };
  const auto next = [](Index half_edge) { return half_edge % 3 == 2 ? half_edge - 2 : half_edge + 1; };
  // A corner has the number of the half-edge that starts there. Corners at a vertex belong to the same fan if edges
  // join their triangles.
  DisjointSets fans(3 * mesh.triangles.size()), components(mesh.triangles.size());
  EdgeTally boundary(mesh, report.boundary_edges, report.first_boundary_edge);
  EdgeTally non_manifold(mesh, report.non_manifold_edges, report.first_non_manifold_edge);
  EdgeTally misoriented(mesh, report.misoriented_edges, report.first_misoriented_edge);
  const std::vector<EdgeUse> uses = sorted_edge_uses(mesh);
  std::int64_t edges = 0;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    ++edges;
    const Index first = edge.front().half_edge;
    for (const EdgeUse& use : edge.subspan(1)) {
      const bool same_direction = start(use.half_edge) == start(first);
      fans.unite(first, same_direction ? use.half_edge : next(use.half_edge));
      fans.unite(next(first), same_direction ? next(use.half_edge) : use.half_edge);
      components.unite(first / 3, use.half_edge / 3);
    }
    if (edge.size() == 1) boundary.add(edge);
    if (edge.size() > 2) non_manifold.add(edge);
    if (edge.size() == 2 && start(first) == start(edge[1].half_edge)) misoriented.add(edge);
  });

  std::vector<Index> fan_counts(mesh.vertices.size(), 0);
  std::vector<bool> used(mesh.vertices.size(), false);
  std::int64_t joined_vertices = 0, joined_triangles = 0;
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    for (const Index vertex : mesh.triangles[t]) used[vertex] = true;
    if (repeats_a_corner(mesh.triangles[t])) continue;
    ++joined_triangles;
    report.components += components.root(t) == t;
    for (Index corner = 3 * t; corner < 3 * t + 3; ++corner) fan_counts[start(corner)] += fans.root(corner) == corner;
  }
  for (Index vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    report.unused_vertices += !used[vertex];
    joined_vertices += fan_counts[vertex] > 0;
    if (fan_counts[vertex] > 1 && report.non_manifold_vertices++ == 0) report.first_non_manifold_vertex = vertex;
  }
  report.euler_characteristic = joined_vertices - edges + joined_triangles;
  std::vector<Index> component_of(mesh.triangles.size());
  for (Index t = 0; t < mesh.triangles.size(); ++t) component_of[t] = components.root(t);
  return component_of;
}

struct Component {
  Index first_triangle = 0;
  Box box;
  double area = 0, volume = 0;  // in the units of check_shape()
};

// Finds components that are inside out: they are oriented against the mesh as a whole and are no cavities, since they
// lie inside no other component. Only the boxes are compared, so not all are found, but those that are found are
// certain. Precondition: the mesh is closed and oriented.
void find_inside_out(std::span<const Component> components, double volume, MeshReport& report) {
  constexpr std::size_t kMaxPairs = 10'000'000;  // a fraction of a second; real meshes have far fewer
  std::vector<const Component*> along, against;
  for (const Component& component : components) {
    if (std::abs(component.volume) <= tolerance::kNoVolume * component.area) continue;
    ((component.volume < 0) == (volume < 0) ? along : against).push_back(&component);
  }
  if (along.size() * against.size() > kMaxPairs) return;
  for (const Component* component : against) {
    if (std::ranges::any_of(along, [&](const Component* other) { return other->box.contains(component->box); }))
      continue;
    if (report.inside_out_components++ == 0) report.first_inside_out_triangle = component->first_triangle;
  }
}

// Computes area, volume and degenerate triangles. Lengths are measured from the centre of the bounding box, in units of
// a power of two near its size, so that neither offset nor scale of the mesh makes the sums inaccurate.
void check_shape(const TriangleMesh& mesh, std::span<const Index> component_of, MeshReport& report) {
  Box box;
  for (const auto& corners : mesh.triangles) {
    for (const Index vertex : corners) box.extend(mesh.vertices[vertex]);
  }
  const Point center = box.min() / 2 + box.max() / 2;
  const double scale = unit_scale(box);
  const int exponent = -std::ilogb(scale);
  double area = 0, volume = 0;
  std::vector<Component> components;
  std::vector<Index> component_number(mesh.triangles.size(), kNone);  // by first triangle
  for (Index t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const std::array<Point, 3> p{mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]};
    const Vector cross = area_vector(p, scale);
    if (cross == Vector::Zero() && report.degenerate_triangles++ == 0) report.first_degenerate_triangle = t;
    const double triangle_area = cross.norm() / 2, cone = ((p[0] - center) * scale).dot(cross) / 6;
    area += triangle_area;
    volume += cone;
    Index& number = component_number[component_of[t]];
    if (number == kNone) {
      number = static_cast<Index>(components.size());
      components.push_back({t, Box(), 0, 0});
    }
    components[number].area += triangle_area;
    components[number].volume += cone;
    for (const Point& corner : p) components[number].box.extend(corner);
  }
  if (std::abs(volume) <= tolerance::kNoVolume * area) volume = 0;
  report.area = std::ldexp(area, 2 * exponent);
  report.volume = std::ldexp(volume, 3 * exponent);
  // Even if the volume is too small for a double, its sign is known.
  if (report.volume == 0 && volume != 0)
    report.volume = std::copysign(std::numeric_limits<double>::denorm_min(), volume);
  if (report.closed() && report.manifold() && report.misoriented_edges == 0)
    find_inside_out(components, volume, report);
}

std::string number_of(Index count, const std::string& singular, const std::string& plural) {
  return std::to_string(count) + " " + (count == 1 ? singular : plural);
}

std::string edge_name(Index count, const std::array<Index, 2>& edge) {
  const std::string vertices = "vertices " + std::to_string(edge[0]) + " and " + std::to_string(edge[1]);
  return count == 1 ? " (it joins " + vertices + ")" : " (the first joins " + vertices + ")";
}

std::string element_name(Index count, const std::string& kind, Index element) {
  return std::string(count == 1 ? " (" : " (the first is ") + kind + " " + std::to_string(element) + ")";
}

}  // namespace

std::string MeshReport::faults() const {
  std::string text;
  const auto add = [&](Index count, const std::string& fault, const std::string& where) {
    if (count > 0) text += (text.empty() ? "" : ", ") + fault + where;
  };
  add(boundary_edges, number_of(boundary_edges, "boundary edge", "boundary edges"),
      edge_name(boundary_edges, first_boundary_edge));
  add(non_manifold_edges, number_of(non_manifold_edges, "non-manifold edge", "non-manifold edges"),
      edge_name(non_manifold_edges, first_non_manifold_edge));
  add(non_manifold_vertices,
      number_of(non_manifold_vertices, "vertex", "vertices") + " where parts of the surface touch at a point",
      element_name(non_manifold_vertices, "vertex", first_non_manifold_vertex));
  add(misoriented_edges, number_of(misoriented_edges, "edge", "edges") + " between triangles of opposite orientation",
      edge_name(misoriented_edges, first_misoriented_edge));
  add(degenerate_triangles, number_of(degenerate_triangles, "degenerate triangle", "degenerate triangles"),
      element_name(degenerate_triangles, "triangle", first_degenerate_triangle));
  add(inside_out_components,
      number_of(inside_out_components, "part", "parts") + " of the mesh turned inside out against the rest",
      element_name(inside_out_components, "at triangle", first_inside_out_triangle));
  // The sign of the volume means something only if nothing else is wrong.
  if (text.empty() && triangles == 0) return "no triangles";
  if (text.empty() && volume < 0) return "it is inside out";
  if (text.empty() && !(volume > 0)) return "it encloses no volume";
  return text;
}

MeshReport check_mesh(const TriangleMesh& mesh) {
  MeshReport report;
  report.vertices = static_cast<Index>(mesh.vertices.size());
  report.triangles = static_cast<Index>(mesh.triangles.size());
  if (mesh.triangles.empty()) {
    report.unused_vertices = report.vertices;
    return report;
  }
  const std::vector<Index> component_of = check_connectivity(mesh, report);
  check_shape(mesh, component_of, report);
  return report;
}

bool require_solid(TriangleMesh& mesh) {
  validate(mesh);
  MeshReport report = check_mesh(mesh);
  const bool inside_out = report.volume < 0;
  report.volume = std::abs(report.volume);
  if (!report.solid()) {
    throw InputError("the mesh is not a closed, consistently oriented manifold: " + report.faults() +
                     " (numbers count from 0); repair it in a mesh editor or remesh it");
  }
  if (inside_out) {
    for (auto& corners : mesh.triangles) std::swap(corners[1], corners[2]);
  }
  assert(agrees(half_edge_mesh(mesh), report));
  return inside_out;
}

}  // namespace orchard
