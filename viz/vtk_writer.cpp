#include "orchard/viz/vtk_writer.h"

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataWriter.h>

#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/xml_escaped.h"
#include "orchard/medial/prune.h"
#include "paraview_script.h"
#include "vtk_data.h"

namespace orchard {

using namespace detail;

namespace {

vtkSmartPointer<vtkPolyData> medial_points(const MedialAxis& axis, const ViewArrays& more) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const std::size_t count = axis.centers.size();
  set_points(data, count, [&](std::size_t i) { return axis.centers[i]; });
  Index components = 0;
  const std::vector<Index> component = connected_components(axis, components);
  vtkPointData* arrays = data->GetPointData();
  add_doubles(arrays, "radius", count, [&](std::size_t i) { return axis.radii[i]; });
  const std::vector<double> angles = contact_angles(axis);
  add_doubles(arrays, "contact_angle", count, [&](std::size_t i) { return in_degrees(angles[i]); });
  add_ints(arrays, "component", count, [&](std::size_t i) { return as_int(component[i]); });
  add_ints(arrays, "valence", count,
           [&](std::size_t i) { return static_cast<int>(axis.neighbors[static_cast<Index>(i)].size()); });
  add_all(arrays, more, count);
  return data;
}

vtkSmartPointer<vtkPolyData> contacts_of(const MedialAxis& axis) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  const std::size_t count = axis.points.size();
  set_points(data, count, [&](std::size_t i) { return axis.points[i]; });
  set_vertex_cells(data);
  add_ints(data->GetPointData(), "origin", count, [&](std::size_t i) { return static_cast<int>(axis.origins[i]); });
  return data;
}

vtkSmartPointer<vtkPolyData> with_topology_of(vtkPolyData* points) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points->GetPoints());
  data->GetPointData()->ShallowCopy(points->GetPointData());
  return data;
}

// Returns for each node the child of the root that it descends from, counted from 0.
std::vector<int> branches(const SphereTree& tree) {
  std::vector<int> branch(tree.nodes.size(), -1);
  for (std::size_t i = 1; i < tree.nodes.size(); ++i) {
    const Index parent = tree.nodes[i].parent;
    branch[i] = parent == 0 ? static_cast<int>(i - tree.nodes[0].first_child) : branch[parent];
  }
  return branch;
}

}  // namespace

void write_mesh(const std::filesystem::path& vtp, const Surface& surface) {
  const TriangleMesh& mesh = surface.mesh();
  vtkNew<vtkPolyData> data;
  set_mesh(data, mesh);
  add_ints(data->GetCellData(), "cluster", mesh.triangles.size(),
           [&](std::size_t i) { return as_int(surface.clusters().of_triangle[i]); });
  add_doubles(data->GetFieldData(), "bounding_radius", 1, [&](std::size_t) { return surface.bounding_radius(); });
  add_doubles(data->GetFieldData(), "diagonal", 1,
              [&](std::size_t) { return surface.bounding_box().diagonal().norm(); });
  write(vtp, data);
}

void write_points(const std::filesystem::path& vtp, const SurfaceSampling& sampling, const ViewArrays& more) {
  vtkNew<vtkPolyData> data;
  const std::size_t count = sampling.points.size();
  set_points(data, count, [&](std::size_t i) { return sampling.points[i]; });
  set_vertex_cells(data);
  add_ints(data->GetPointData(), "origin", count, [&](std::size_t i) { return static_cast<int>(sampling.origins[i]); });
  add_ints(data->GetPointData(), "triangle", count, [&](std::size_t i) { return as_int(sampling.triangles[i]); });
  add_all(data->GetPointData(), more, count);
  write(vtp, data);
}

std::filesystem::path with_ending(const std::filesystem::path& prefix, const std::string& ending) {
  std::filesystem::path file = prefix;
  return file += ending;
}

void write_medial_axis(const std::filesystem::path& prefix, const MedialAxis& axis, const ViewArrays& of_vertices,
                       const ViewArrays& of_faces) {
  const vtkSmartPointer<vtkPolyData> points = medial_points(axis, of_vertices);

  const vtkSmartPointer<vtkPolyData> vertices = with_topology_of(points);
  set_vertex_cells(vertices);
  write(with_ending(prefix, "-vertices.vtp"), vertices);

  vtkNew<vtkCellArray> lines;
  for (Index i = 0; i < axis.size(); ++i) {
    for (const Index j : axis.neighbors[i]) {
      if (i < j) add_cell(lines, std::array{i, j});
    }
  }
  const vtkSmartPointer<vtkPolyData> edges = with_topology_of(points);
  edges->SetLines(lines);
  write(with_ending(prefix, "-edges.vtp"), edges);

  vtkNew<vtkCellArray> polygons;
  for (Index i = 0; i < axis.faces.size(); ++i) add_cell(polygons, axis.faces[i]);
  const vtkSmartPointer<vtkPolyData> faces = with_topology_of(points);
  faces->SetPolys(polygons);
  const std::size_t count = axis.face_points.size();
  add_ints(faces->GetCellData(), "point_a", count, [&](std::size_t i) { return as_int(axis.face_points[i][0]); });
  add_ints(faces->GetCellData(), "point_b", count, [&](std::size_t i) { return as_int(axis.face_points[i][1]); });
  add_doubles(faces->GetCellData(), "contact_angle", count, [&](std::size_t i) {
    return in_degrees(separation_angle(axis, axis.faces[static_cast<Index>(i)], axis.face_points[i]));
  });
  add_all(faces->GetCellData(), of_faces, count);
  write(with_ending(prefix, "-faces.vtp"), faces);
  write(with_ending(prefix, "-contacts.vtp"), contacts_of(axis));
}

void write_tree_level(const std::filesystem::path& vtp, const SphereTree& tree, Index level) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const SphereNode& node = tree.nodes[i];
    if (node.level == level || (node.level < level && node.child_count == 0)) shown.push_back(i);
  }
  const std::vector<int> branch = branches(tree);
  const auto node = [&](std::size_t i) -> const SphereNode& { return tree.nodes[shown[i]]; };

  vtkNew<vtkPolyData> data;
  set_points(data, shown.size(), [&](std::size_t i) { return node(i).sphere.center; });
  set_vertex_cells(data);
  vtkPointData* arrays = data->GetPointData();
  add_doubles(arrays, "radius", shown.size(), [&](std::size_t i) { return node(i).sphere.radius; });
  add_doubles(arrays, "error", shown.size(), [&](std::size_t i) { return finite_or_no_value(node(i).distance_bound); });
  add_doubles(arrays, "inaccuracy", shown.size(),
              [&](std::size_t i) { return finite_or_no_value(node(i).inaccuracy); });
  add_ints(arrays, "level", shown.size(), [&](std::size_t i) { return as_int(node(i).level); });
  add_ints(arrays, "node", shown.size(), [&](std::size_t i) { return static_cast<int>(shown[i]); });
  add_ints(arrays, "parent", shown.size(), [&](std::size_t i) { return as_int(node(i).parent); });
  add_ints(arrays, "branch", shown.size(), [&](std::size_t i) { return branch[shown[i]]; });
  add_ints(arrays, "carried", shown.size(), [&](std::size_t i) { return node(i).level < level ? 1 : 0; });
  write(vtp, data);
}

void write_multiblock(const std::filesystem::path& vtm, std::span<const NamedFile> files) {
  write_file(vtm, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
           "  <vtkMultiBlockDataSet>\n";
    for (std::size_t i = 0; i < files.size(); ++i) {
      out << "    <DataSet index=\"" << i << "\" name=\"" << xml_escaped(files[i].name) << "\" file=\""
          << xml_escaped(files[i].file.generic_string()) << "\"/>\n";
    }
    out << "  </vtkMultiBlockDataSet>\n</VTKFile>\n";
  });
}

std::vector<NamedFile> write_pipeline(const std::filesystem::path& prefix, const PipelineValues& values) {
  std::vector<NamedFile> files;
  const auto add = [&](const std::string& name, const std::string& ending) {
    std::filesystem::path file = with_ending(prefix, ending);
    files.push_back({name, file.filename()});
    return file;
  };
  if (values.surface != nullptr) write_mesh(add("mesh", "-mesh.vtp"), *values.surface);
  if (values.sampling != nullptr) write_points(add("surface points", "-points.vtp"), *values.sampling);
  if (values.axis != nullptr) {
    write_medial_axis(with_ending(prefix, "-medial"), *values.axis);
    for (const std::string part : {"vertices", "edges", "faces"}) add("medial " + part, "-medial-" + part + ".vtp");
  }
  if (values.tree != nullptr && !values.tree->nodes.empty()) {
    for (Index level = 0; level <= values.tree->depth(); ++level) {
      const std::string number = std::to_string(level);
      write_tree_level(add("tree level " + number, "-level-" + number + ".vtp"), *values.tree, level);
    }
  }
  if (values.spheres != nullptr) write_tree_level(add("spheres", "-spheres.vtp"), *values.spheres, 1);
  write_multiblock(with_ending(prefix, ".vtm"), files);
  if (values.tree != nullptr && !values.tree->nodes.empty()) write_levels_in_time(prefix, values.tree->depth());
  if (values.surface != nullptr) write_paraview_script(prefix, values);
  return files;
}

}  // namespace orchard
