#include "orchard/viz/medial_writer.h"

#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <algorithm>
#include <span>

#include "orchard/medial/prune.h"
#include "orchard/medial/structure.h"
#include "vtk_data.h"

namespace orchard {

using namespace detail;

namespace {

struct Cell {
  std::vector<Index> corners;
  Index segment = kNone, part = kNone, point_a = kNone, point_b = kNone;
  bool for_topology = false;
  double angle = kNoValue;
};

void add_faces(const Rows& faces, const std::vector<std::array<Index, 2>>& points, const std::vector<Index>& segments,
               std::span<const Index> parts, bool for_topology, const MedialAxis& axis, std::vector<Cell>& cells) {
  for (Index face = 0; face < faces.size(); ++face) {
    const auto corners = faces[face];
    cells.push_back({.corners = {corners.begin(), corners.end()},
                     .segment = segments[face],
                     .part = parts[face],
                     .point_a = points[face][0],
                     .point_b = points[face][1],
                     .for_topology = for_topology,
                     .angle = separation_angle(axis, corners, points[face])});
  }
}

std::vector<Cell> cells_of(const MedialAxis& axis, const MedialSegments& segments, const MedialStructure& structure) {
  std::vector<Cell> cells;
  const std::span<const Index> sheets = structure.of_face;
  add_faces(axis.faces, axis.face_points, segments.of_face, sheets, false, axis, cells);
  add_faces(axis.topology_faces, axis.topology_face_points, segments.of_topology_face,
            sheets.subspan(axis.faces.size()), true, axis, cells);
  std::size_t edge = 0;
  for (Index i = 0; i < axis.size(); ++i) {
    for (const Index next : axis.neighbors[i]) {
      if (next < i) continue;
      const Index segment = segments.of_edge[edge], part = structure.of_edge[edge];
      ++edge;
      if (segment != kNone) cells.push_back({.corners = {i, next}, .segment = segment, .part = part});
    }
  }
  return cells;
}

// Adds the part of the structure that each point or cell belongs to, and the kind of that part.
template <class PartOf>
void add_structure(const MedialStructure& structure, std::size_t count, const PartOf& part_of, vtkFieldData* data) {
  add_ints(data, "structure", count, [&](std::size_t i) { return as_int(part_of(i)); });
  add_ints(data, "structure_kind", count,
           [&](std::size_t i) { return static_cast<int>(structure.parts[part_of(i)].kind); });
}

void add_contacts(const AxisContacts& contacts, vtkFieldData* data) {
  const std::size_t count = contacts.balls.size(), samples = contacts.sample_places.size();
  add_ints(data, "contact_ball", count, [&](std::size_t i) { return as_int(contacts.balls[i]); });
  add_ints(data, "contact_sample", count, [&](std::size_t i) { return as_int(contacts.samples[i]); });
  add_ints(data, "sample_ball", samples, [&](std::size_t i) { return as_int(contacts.sample_balls[i]); });
  vtkNew<vtkDoubleArray> places;
  places->SetName("samples");
  places->SetNumberOfComponents(3);
  places->SetNumberOfTuples(static_cast<vtkIdType>(samples));
  for (std::size_t i = 0; i < samples; ++i)
    places->SetTuple(static_cast<vtkIdType>(i), contacts.sample_places[i].data());
  data->AddArray(places);
}

bool added(const MedialAxis& axis, Index point) { return point != kNone && axis.origins[point] == PointOrigin::repair; }

void add_point_arrays(const MedialAxis& axis, const MedialSegments& segments, const std::vector<Index>& components,
                      vtkPointData* data) {
  const std::size_t count = axis.centers.size();
  const std::vector<double> angles = contact_angles(axis);
  const auto row = [&](std::size_t i) { return axis.forming_points[static_cast<Index>(i)]; };
  add_doubles(data, "radius", count, [&](std::size_t i) { return axis.radii[i]; });
  add_doubles(data, "contact_angle", count, [&](std::size_t i) { return in_degrees(angles[i]); });
  add_ints(data, "component", count, [&](std::size_t i) { return as_int(components[i]); });
  add_ints(data, "segment", count, [&](std::size_t i) { return as_int(segments.of_vertex[i]); });
  add_ints(data, "added", count, [&](std::size_t i) {
    const auto forming = row(i);
    return std::any_of(forming.begin(), forming.end(), [&](Index point) { return added(axis, point); }) ? 1 : 0;
  });
  add_ints(data, "forming_count", count, [&](std::size_t i) { return static_cast<int>(row(i).size()); });
  vtkNew<vtkIntArray> forming;
  forming->SetName("forming_points");
  forming->SetNumberOfComponents(4);
  forming->SetNumberOfTuples(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      forming->SetComponent(static_cast<vtkIdType>(i), static_cast<int>(k), k < row(i).size() ? row(i)[k] : -1.0);
    }
  }
  data->AddArray(forming);
}

void add_cell_arrays(const MedialAxis& axis, const MedialSegments& segments, const std::vector<Index>& components,
                     const std::vector<Cell>& cells, vtkCellData* data) {
  const std::size_t count = cells.size();
  add_ints(data, "segment", count, [&](std::size_t i) { return as_int(cells[i].segment); });
  add_ints(data, "has_faces", count,
           [&](std::size_t i) { return segments.segments[cells[i].segment].has_faces ? 1 : 0; });
  add_ints(data, "trunk", count, [&](std::size_t i) { return segments.segments[cells[i].segment].trunk ? 1 : 0; });
  add_ints(data, "topology_face", count, [&](std::size_t i) { return cells[i].for_topology ? 1 : 0; });
  add_doubles(data, "contact_angle", count, [&](std::size_t i) { return in_degrees(cells[i].angle); });
  add_ints(data, "point_a", count, [&](std::size_t i) { return as_int(cells[i].point_a); });
  add_ints(data, "point_b", count, [&](std::size_t i) { return as_int(cells[i].point_b); });
  add_ints(data, "added", count,
           [&](std::size_t i) { return added(axis, cells[i].point_a) || added(axis, cells[i].point_b) ? 1 : 0; });
  add_ints(data, "component", count, [&](std::size_t i) { return as_int(components[cells[i].corners[0]]); });
}

}  // namespace

void write_medial_grid(const std::filesystem::path& vtu, const MedialAxis& axis, const MedialSegments& segments,
                       const ViewArrays& of_vertices, const ViewArrays& of_faces) {
  vtkNew<vtkUnstructuredGrid> grid;
  set_points(grid, axis.centers.size(), [&](std::size_t i) { return axis.centers[i]; });
  const MedialStructure structure = medial_structure(axis);
  const std::vector<Cell> cells = cells_of(axis, segments, structure);
  for (const Cell& cell : cells) {
    std::vector<vtkIdType> corners(cell.corners.begin(), cell.corners.end());
    grid->InsertNextCell(corners.size() == 2 ? VTK_LINE : VTK_POLYGON, static_cast<vtkIdType>(corners.size()),
                         corners.data());
  }
  Index count = 0;
  const std::vector<Index> components = connected_components(axis, count);
  add_point_arrays(axis, segments, components, grid->GetPointData());
  add_cell_arrays(axis, segments, components, cells, grid->GetCellData());
  add_structure(
      structure, axis.centers.size(), [&](std::size_t i) { return structure.of_vertex[i]; }, grid->GetPointData());
  add_structure(
      structure, cells.size(), [&](std::size_t i) { return cells[i].part; }, grid->GetCellData());
  add_all(grid->GetPointData(), of_vertices, axis.centers.size());
  for (const ViewArray& array : of_faces) {
    add_doubles(grid->GetCellData(), array.name.c_str(), cells.size(),
                [&](std::size_t i) { return i < array.values.size() ? array.values[i] : kNoValue; });
  }
  add_contacts(axis_contacts(axis), grid->GetFieldData());
  write_with<vtkXMLUnstructuredGridWriter>(vtu, grid.GetPointer());
}

void write_thickness(const std::filesystem::path& vtp, const Surface& surface, const std::vector<double>& radii,
                     const ViewArrays& more) {
  vtkNew<vtkPolyData> data;
  set_mesh(data, surface.mesh());
  add_doubles(data->GetPointData(), "medial_radius", radii.size(), [&](std::size_t i) { return radii[i]; });
  add_doubles(data->GetPointData(), "thickness", radii.size(), [&](std::size_t i) { return 2 * radii[i]; });
  add_all(data->GetPointData(), more, radii.size());
  write(vtp, data);
}

void write_medial_mesh(const std::filesystem::path& vtp, const MedialMesh& mesh, const ViewArrays& of_vertices,
                       const AxisContacts* contacts) {
  vtkNew<vtkPolyData> data;
  set_points(data, mesh.centers.size(), [&](std::size_t i) { return mesh.centers[i]; });
  const MedialStructure structure = medial_structure(mesh);
  vtkNew<vtkCellArray> triangles, lines;
  std::vector<Index> parts;  // of each cell, where lines come first
  for (Index e = 0; e < mesh.edges.size(); ++e) {
    if (!structure.on_curve(e)) continue;
    add_cell(lines, mesh.edges[e]);
    parts.push_back(structure.of_edge[e]);
  }
  for (const auto& triangle : mesh.triangles) add_cell(triangles, triangle);
  parts.insert(parts.end(), structure.of_face.begin(), structure.of_face.end());
  data->SetPolys(triangles);
  data->SetLines(lines);
  add_doubles(data->GetPointData(), "radius", mesh.radii.size(), [&](std::size_t i) { return mesh.radii[i]; });
  add_structure(
      structure, mesh.radii.size(), [&](std::size_t i) { return structure.of_vertex[i]; }, data->GetPointData());
  add_structure(
      structure, parts.size(), [&](std::size_t i) { return parts[i]; }, data->GetCellData());
  add_all(data->GetPointData(), of_vertices, mesh.radii.size());
  if (contacts != nullptr) add_contacts(*contacts, data->GetFieldData());
  write(vtp, data);
}

void write_worst_places(const std::filesystem::path& vtp, const std::vector<WorstPlace>& places) {
  vtkNew<vtkPolyData> data;
  set_points(data, places.size(), [&](std::size_t i) { return places[i].position; });
  set_vertex_cells(data);
  vtkPointData* arrays = data->GetPointData();
  add_ints(arrays, "number", places.size(), [](std::size_t i) { return static_cast<int>(i) + 1; });
  add_ints(arrays, "measure", places.size(), [&](std::size_t i) { return static_cast<int>(places[i].kind); });
  add_doubles(arrays, "value", places.size(), [&](std::size_t i) { return 100 * places[i].value; });
  vtkNew<vtkDoubleArray> outward;
  outward->SetName("outward");
  outward->SetNumberOfComponents(3);
  outward->SetNumberOfTuples(static_cast<vtkIdType>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    outward->SetTuple(static_cast<vtkIdType>(i), places[i].outward.data());
  arrays->AddArray(outward);
  write(vtp, data);
}

void write_structure_graph(const std::filesystem::path& vtp, const MedialAxis& axis, const StructureGraph& graph) {
  std::vector<Index> vertices;
  for (const auto& arc : graph.arcs) vertices.insert(vertices.end(), arc.vertices.begin(), arc.vertices.end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  vtkNew<vtkPolyData> data;
  set_points(data, vertices.size(), [&](std::size_t i) { return axis.centers[vertices[i]]; });
  vtkNew<vtkCellArray> lines;
  for (const auto& arc : graph.arcs) {
    std::vector<Index> line;
    for (const Index vertex : arc.vertices) {
      line.push_back(static_cast<Index>(std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin()));
    }
    add_cell(lines, line);
  }
  data->SetLines(lines);
  add_doubles(data->GetPointData(), "radius", vertices.size(), [&](std::size_t i) { return axis.radii[vertices[i]]; });
  add_ints(data->GetPointData(), "vertex", vertices.size(), [&](std::size_t i) { return as_int(vertices[i]); });
  vtkCellData* cells = data->GetCellData();
  const std::size_t count = graph.arcs.size();
  add_ints(cells, "kind", count, [&](std::size_t i) { return static_cast<int>(graph.arcs[i].kind); });
  add_doubles(cells, "length", count, [&](std::size_t i) { return graph.arcs[i].length; });
  add_doubles(cells, "mean_radius", count, [&](std::size_t i) { return graph.arcs[i].mean_radius; });
  add_ints(cells, "from", count, [&](std::size_t i) { return as_int(graph.arcs[i].from); });
  add_ints(cells, "to", count, [&](std::size_t i) { return as_int(graph.arcs[i].to); });
  write(vtp, data);
}

}  // namespace orchard
