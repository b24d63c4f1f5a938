#include "robot/link_shape.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#include "input/input_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/wrap.h"
#include "robot/primitive_mesh.h"

namespace orchard::robot {
namespace {

// A wrap of some thousand triangles: links have few spheres, and need no more.
constexpr WrapOptions kWrap{.alpha = 0.025, .offset = 0.002};

struct ElementMesh {
  TriangleMesh mesh;  // around the element's own origin, before its scale
  double deviation = 0;
  std::vector<std::string> notes;
};

ElementMesh read(const Element& element, const DaeOptions& dae) {
  if (element.shape != Shape::mesh) {
    PrimitiveMesh primitive = primitive_mesh(element);
    return {std::move(primitive.mesh), primitive.deviation, {}};
  }
  if (apps::lower_extension(element.file) == ".dae") return {read_dae(element.file, dae), 0, {}};
  auto [mesh, report] = read_mesh_and_report(element.file);
  return {std::move(mesh), 0, report.faults()};
}

TriangleMesh moved(TriangleMesh mesh, const Element& element) {
  for (Point& vertex : mesh.vertices) vertex = element.origin * element.scale.cwiseProduct(vertex);
  if (element.scale.prod() < 0)
    for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

void append(const TriangleMesh& more, TriangleMesh& mesh) {
  const auto first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), more.vertices.begin(), more.vertices.end());
  for (const auto& [a, b, c] : more.triangles) mesh.triangles.push_back({first + a, first + b, first + c});
}

std::string name_of(const Element& element) {
  return element.shape == Shape::mesh ? element.file.string() : fmt::format("the element of line {}", element.line);
}

// What a shape is put together from.
struct Parts {
  TriangleMesh original, mended;
  bool repaired = false, wrapped = false;
  double deviation = 0;
  std::vector<std::string> notes;
};

// Makes a solid of a mesh where that can be, and notes what was done.
void mend(const ShapeOptions& options, TriangleMesh& mesh, Parts& shape, const std::string& name) {
  RepairMeshOptions repair;
  if (options.join) repair.join_distance = *options.join;
  TriangleMesh repaired = mesh;
  const MeshRepairReport report = repair_mesh(repaired, repair);
  if (report.solid) {
    for (const std::string& line : report.lines()) shape.notes.push_back(fmt::format("{}: {}", name, line));
    shape.repaired = shape.repaired || report.changed();
    mesh = std::move(repaired);
    return;
  }
  if (!options.wrap) {
    shape.notes.push_back(fmt::format("{}: no solid, even after repair: {}", name, report.faults));
    return;
  }
  mesh = wrap_mesh(mesh, kWrap);
  shape.wrapped = true;
  shape.notes.push_back(
      fmt::format("{}: no solid, even after repair ({}): WRAPPED in a closed skin about {:g} % of its diagonal outside",
                  name, report.faults, 100 * kWrap.offset));
}

}  // namespace

TriangleMesh element_mesh(const Element& element, const DaeOptions& dae) {
  return moved(read(element, dae).mesh, element);
}

std::optional<LinkShape> link_shape(const Robot& robot, Index link, const ShapeOptions& options) {
  const std::vector<Element>& elements = elements_of(robot.links[link], options.geometry);
  if (elements.empty()) return std::nullopt;
  Parts parts;
  for (const Element& element : elements) {
    ElementMesh own = read(element, options.dae);
    for (const std::string& fault : own.notes) parts.notes.push_back(name_of(element) + ": " + fault);
    parts.deviation = std::max(parts.deviation, own.deviation);
    append(moved(own.mesh, element), parts.original);
    mend(options, own.mesh, parts, name_of(element));
    append(moved(std::move(own.mesh), element), parts.mended);
  }
  if (parts.deviation > 0)
    parts.notes.push_back(
        fmt::format("curved primitives are polyhedra around them, {:.2g} m outside at most", parts.deviation));
  return LinkShape{.link = link,
                   .original = std::move(parts.original),
                   .surface = Surface(std::move(parts.mended)),
                   .repaired = parts.repaired,
                   .wrapped = parts.wrapped,
                   .deviation = parts.deviation,
                   .notes = std::move(parts.notes)};
}

std::vector<LinkShape> link_shapes(const Robot& robot, const ShapeOptions& options, const Progress& progress) {
  report_progress(progress, "reading links", 0);
  std::vector<std::optional<LinkShape>> all(robot.links.size());
  tbb::parallel_for(std::size_t{0}, all.size(),
                    [&](std::size_t i) { all[i] = link_shape(robot, static_cast<Index>(i), options); });
  std::vector<LinkShape> shapes;
  for (std::optional<LinkShape>& shape : all)
    if (shape) shapes.push_back(std::move(*shape));
  return shapes;
}

}  // namespace orchard::robot
