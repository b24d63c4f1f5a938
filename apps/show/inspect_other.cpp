#include "show/inspect_other.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "orchard/geometry/mesh_io.h"
#include "orchard/medial/quality.h"
#include "orchard/medial/read_axis.h"
#include "orchard/medial/structure.h"
#include "orchard/medial/topology.h"
#include "output/json_values.h"
#include "spheres/sphere_files.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

void add_box(const Box& box, json& report) {
  report["diagonal"] = box.diagonal().norm();
  report["bounds"] = {point_json(box.min()), point_json(box.max())};
}

Box box_around(const std::vector<Sphere>& balls) {
  Box box;
  for (const Sphere& ball : balls) {
    box.extend(ball.center - Vector::Constant(ball.radius));
    box.extend(ball.center + Vector::Constant(ball.radius));
  }
  return box;
}

double area_of(const MedialMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    area += (mesh.centers[b] - mesh.centers[a]).cross(mesh.centers[c] - mesh.centers[a]).norm() / 2;
  return area;
}

json parts_json(const MedialStructure& structure) {
  json parts;
  for (const StructureKind kind : {StructureKind::sheet, StructureKind::seam, StructureKind::border,
                                   StructureKind::curve, StructureKind::junction})
    parts[name_of(kind)] = structure.count(kind);
  return parts;
}

json spheres_json(const SphereGroup& group) {
  const auto [least, most] = std::minmax_element(group.spheres.begin(), group.spheres.end(),
                                                 [](const Sphere& a, const Sphere& b) { return a.radius < b.radius; });
  double volume = 0;
  for (const Sphere& ball : group.spheres) volume += 4 * std::numbers::pi / 3 * std::pow(ball.radius, 3);
  json report{{"spheres", group.spheres.size()}, {"switched_off", group.switched_off}, {"buffer", group.buffer}};
  if (group.spheres.empty()) return report;
  report["radii"] = {least->radius, most->radius};
  report["sum_of_volumes"] = volume;
  add_box(box_around(group.spheres), report);
  return report;
}

}  // namespace

json inspect_axis(const std::filesystem::path& file) {
  const ForeignAxis axis = read_axis(file);
  const MedialMesh& mesh = axis.mesh;
  const Topology found = topology(mesh);
  std::vector<Sphere> balls;
  for (Index v = 0; v < mesh.size(); ++v) balls.push_back({mesh.centers[v], mesh.radii[v]});
  json report{{"kind", "medial axis"},
              {"balls", mesh.size()},
              {"edges", mesh.edges.size()},
              {"triangles", mesh.triangles.size()},
              {"parts", parts_json(medial_structure(mesh))},
              {"components", found.components},
              {"loops", found.loops},
              {"cavities", found.cavities},
              {"area", area_of(mesh)},
              {"border_length", border_length(mesh)},
              {"notes", axis.notes}};
  report["radii"] = axis.has_radii ? json{*std::min_element(mesh.radii.begin(), mesh.radii.end()),
                                          *std::max_element(mesh.radii.begin(), mesh.radii.end())}
                                   : json();
  add_box(box_around(balls), report);
  return report;
}

json inspect_spheres(const std::filesystem::path& file) {
  const SphereFile read = read_sphere_file(file);
  json report{{"kind", "sphere set"}, {"format", read.format}};
  if (read.groups.size() == 1) {
    report.update(spheres_json(read.groups.front()));
    return report;
  }
  std::size_t spheres = 0;
  for (const SphereGroup& group : read.groups) {
    report["links"][group.name] = spheres_json(group);
    spheres += group.spheres.size();
  }
  report["spheres"] = spheres;
  return report;
}

std::optional<json> inspect_points(const std::filesystem::path& file, const MeshInput& input) {
  const TriangleMesh mesh = read_input_or_points(file, input).mesh;
  if (!mesh.triangles.empty()) return std::nullopt;
  Box box;
  for (const Point& point : mesh.vertices) box.extend(point);
  json report{{"kind", "points"}, {"points", mesh.vertices.size()}};
  add_box(box, report);
  return report;
}

}  // namespace orchard::apps
