// Medial axes: built, read, written, and what they are made of.
#include "medial_types.h"

#include <cmath>
#include <optional>

#include "medial/medial_tuning.h"
#include "orchard/geometry/atomic_file.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/outside_solid.h"
#include "orchard/medial/medial_mesh_formats.h"
#include "orchard/medial/prune.h"
#include "orchard/medial/read_axis.h"
#include "orchard/medial/segments.h"

namespace orchard::python {
namespace {

// Every tuning option: name, what it trades, standard value, range, choices.
py::list tuning_table() {
  py::list table;
  for (const apps::TuningFlag& flag : apps::tuning_flags()) {
    py::dict row;
    row["name"] = flag.name;
    row["help"] = flag.help;
    row["standard"] = flag.standard;
    row["choices"] = flag.choices;
    row["low"] = flag.low;
    row["high"] = flag.high;
    row["whole"] = flag.whole;
    row["step"] = static_cast<int>(flag.step);
    table.append(row);
  }
  return table;
}

py::dict report_of(const MedialBuild& build) {
  py::dict seconds;
  for (const auto& [stage, time] : build.seconds) seconds[py::str(stage)] = time;
  py::dict report;
  report["points"] = build.points;
  report["points_added"] = build.sampling.size() - std::min(build.sampling.size(), build.points);
  report["faces_still_crossing"] = build.gap_repair.faces_still_crossing;
  report["unpruned_vertices"] = build.unpruned_vertices;
  report["open_places"] = build.open_places;
  report["seconds"] = seconds;
  const PromiseCheck& check = build.promise;
  report["promise_kept"] = check.kept();
  report["promise_proven"] = check.proven();
  report["open_promised"] = check.promise.open ? py::object(py::float_(*check.promise.open)) : py::object(py::none());
  report["open_upper"] = check.open_upper;
  report["protrusion_promised"] =
      check.promise.protrusion ? py::object(py::float_(*check.promise.protrusion)) : py::object(py::none());
  report["protrusion_upper"] = check.protrusion_upper;
  report["topology_kept"] = check.keeps_topology();
  return report;
}

py::tuple build(const SurfacePointer& solid, const Tuning& tuning, const py::object& points, const py::object& features,
                bool outside, double outside_radius, bool check_promise, py::object progress) {
  MedialBuildOptions options = to_build_options(tuning);
  options.check_promise = check_promise;
  if (!features.is_none()) {
    if (!options.refine) throw py::value_error("features has no effect with refine='no'");
    options.refine->features = Input<Index>(features, 2).rows<std::array<Index, 2>>();
  }
  MedialBuildInput input;
  if (!points.is_none()) input.sampling = own_sampling(*solid, points);
  AxisPointer axis = watched(std::move(progress), [&](const Progress& watch) {
    SurfacePointer surface = solid;
    if (outside) {
      surface = std::make_shared<Surface>(outside_solid(*solid, outside_radius), solid->ball_kind());
      input.sampling = sample_outside(*solid, *surface, options.sampling, watch);
    }
    auto result = std::make_shared<const MedialBuild>(build_medial_axis(*surface, options, watch, std::move(input)));
    AxisPointer built = Axis::of_mesh(surface, medial_mesh(result->axis));
    built->build = result;
    built->options = options;
    return built;
  });
  return py::make_tuple(axis, report_of(*axis->build));
}

AxisPointer read(const SurfacePointer& surface, const std::filesystem::path& file, bool connect) {
  const py::gil_scoped_release release;
  PlacedAxis placed = place_axis(*surface, read_axis(file), {.connect = connect});
  AxisPointer axis = Axis::of_mesh(surface, std::move(placed.mesh));
  axis->notes = std::move(placed.notes);
  return axis;
}

AxisPointer of_arrays(const SurfacePointer& surface, const py::buffer& centers, const py::buffer& radii,
                      const py::buffer& edges, const py::buffer& faces) {
  MedialMesh mesh{.centers = to_points(centers),
                  .radii = Input<double>(radii, 0).rows<double>(),
                  .edges = Input<Index>(edges, 2).rows<std::array<Index, 2>>(),
                  .triangles = Input<Index>(faces, 3).rows<std::array<Index, 3>>()};
  const py::gil_scoped_release release;
  complete(mesh);
  validate(mesh);
  return Axis::of_mesh(surface, std::move(mesh));
}

// The text that the command line writes to a file of this format.
std::string text_of(const Axis& axis, const std::string& format) {
  if (format == "ma") return to_ma(axis.mesh) + to_structure_section(axis.structure);
  if (format == "ply") return to_ply(axis.mesh);
  if (format == "obj") return to_obj(axis.mesh);
  if (format == "graphml") {
    const MedialAxis complex = axis.build ? axis.build->axis : complex_of(axis.mesh);
    return to_graphml(structure_graph(complex), complex);
  }
  throw py::value_error("format: '" + format + "' is not one of ma, ply, obj, graphml");
}

void save(const Axis& axis, const std::filesystem::path& file, const std::string& format) {
  const py::gil_scoped_release release;
  write_file(file, text_of(axis, format));
}

// NaN for vertices that cutting faces into triangles has added, and for an axis that was not built here.
Array vertex_angles(const Axis& axis) {
  std::vector<double> angles(axis.mesh.size(), std::nan(""));
  if (axis.build) {
    const std::vector<double> known = contact_angles(axis.build->axis);
    std::copy(known.begin(), known.end(), angles.begin());
  }
  return own(std::move(angles));
}

py::dict structure(const Axis& axis) {
  std::vector<std::uint8_t> kinds;
  std::vector<Index> cells;
  py::list vertices;
  for (const MedialStructure::Part& part : axis.structure.parts) {
    kinds.push_back(static_cast<std::uint8_t>(part.kind));
    cells.push_back(part.cells);
    vertices.append(own(part.vertices));
  }
  py::dict result;
  result["kinds"] = own(std::move(kinds));
  result["cells"] = own(std::move(cells));
  result["vertices"] = vertices;
  result["of_face"] = own(axis.structure.of_face);
  result["of_edge"] = own(axis.structure.of_edge);
  result["of_vertex"] = own(axis.structure.of_vertex);
  return result;
}

py::dict structure_graph_of(const Axis& axis) {
  StructureGraph graph;
  {
    const py::gil_scoped_release release;
    graph = structure_graph(axis.build ? axis.build->axis : complex_of(axis.mesh));
  }
  constexpr std::array kNames{"curve", "border", "seam"};
  py::list arcs;
  for (StructureGraph::Arc& arc : graph.arcs) {
    py::dict row;
    row["from"] = arc.from;
    row["to"] = arc.to;
    row["kind"] = kNames[static_cast<std::size_t>(arc.kind)];
    row["length"] = arc.length;
    row["mean_radius"] = arc.mean_radius;
    row["vertices"] = own(std::move(arc.vertices));
    arcs.append(row);
  }
  py::dict result;
  result["nodes"] = own(std::move(graph.nodes));
  result["arcs"] = arcs;
  return result;
}

}  // namespace

AxisPointer Axis::of_mesh(const SurfacePointer& surface, MedialMesh mesh) {
  auto axis = std::make_shared<Axis>();
  axis->surface = surface;
  axis->mesh = std::move(mesh);
  axis->structure = medial_structure(axis->mesh);
  return axis;
}

MedialBuildOptions to_build_options(const Tuning& tuning) {
  apps::MedialTuning options;
  for (const auto& [name, value] : tuning) {
    for (const apps::TuningFlag& flag : apps::tuning_flags()) {
      if (flag.name != name) continue;
      if (const std::string fault = flag.fault(value); !fault.empty())
        throw py::value_error(std::string(name).append(": ").append(fault));
      flag.set(options, value);
    }
  }
  for (const auto& [name, value] : tuning) {
    for (const apps::TuningFlag& flag : apps::tuning_flags()) {
      if (flag.name != name || !flag.unused) continue;
      if (const std::string cause = flag.unused(options); !cause.empty())
        throw py::value_error(std::string(name).append(" has no effect with ").append(cause));
    }
  }
  return apps::build_options(options);
}

MedialAxis complex_of(const MedialMesh& mesh) {
  MedialAxis axis;
  axis.centers = mesh.centers;
  axis.radii = mesh.radii;
  std::vector<std::vector<Index>> neighbors(mesh.size());
  for (const auto& [a, b] : mesh.edges) {
    neighbors[a].push_back(b);
    neighbors[b].push_back(a);
  }
  for (std::vector<Index>& row : neighbors) {
    std::sort(row.begin(), row.end());
    axis.neighbors.items.insert(axis.neighbors.items.end(), row.begin(), row.end());
    axis.neighbors.close_row();
  }
  for (const auto& triangle : mesh.triangles) {
    axis.faces.items.insert(axis.faces.items.end(), triangle.begin(), triangle.end());
    axis.faces.close_row();
    axis.face_points.push_back({kNone, kNone});
  }
  return axis;
}

SurfaceSampling own_sampling(const Surface& surface, const py::buffer& rows) {
  SurfaceSampling sampling{.points = to_points(rows), .triangles = {}, .features = {}, .origins = {}};
  if (sampling.points.size() < 4) throw py::value_error("points: four at least are needed");
  sampling.origins.assign(sampling.points.size(), PointOrigin::face);
  for (Point& point : sampling.points) {
    const ClosestPoint place = surface.closest(point);
    sampling.triangles.push_back(place.triangle);
    sampling.features.push_back(place.feature);
    point = place.position;
  }
  return sampling;
}

void bind_medial(py::module_& module) {
  py::class_<Axis, AxisPointer>(module, "MedialAxis")
      .def("surface", [](const Axis& axis) { return axis.surface; })
      .def("vertices", [](const AxisPointer& axis) { return view_rows<double>(axis, axis->mesh.centers); })
      .def("radii", [](const AxisPointer& axis) { return view_rows<double>(axis, axis->mesh.radii); })
      .def("edges", [](const AxisPointer& axis) { return view_rows<Index>(axis, axis->mesh.edges); })
      .def("faces", [](const AxisPointer& axis) { return view_rows<Index>(axis, axis->mesh.triangles); })
      .def("features",
           [](const AxisPointer& axis) {
             return axis->build ? view_rows<Index>(axis, axis->build->features)
                                : own_rows<Index>(std::vector<std::array<Index, 2>>{});
           })
      .def("points",
           [](const AxisPointer& axis) {
             return axis->build ? view_rows<double>(axis, axis->build->sampling.points)
                                : own_rows<double>(std::vector<Point>{});
           })
      .def("built", [](const Axis& axis) { return axis.build != nullptr; })
      .def("notes", [](const Axis& axis) { return axis.notes; })
      .def("vertex_angles", &vertex_angles)
      .def("structure", &structure)
      .def("structure_graph", &structure_graph_of)
      .def("text", &text_of)
      .def("save", &save);
  module.def("tuning_table", &tuning_table);
  module.def("medial_axis", &build);
  module.def("read_axis", &read);
  module.def("axis_of_arrays", &of_arrays);
  module.def("axis_extensions", [] {
    const auto all = axis_extensions();
    return std::vector<std::string>(all.begin(), all.end());
  });
  bind_medial_measures(module);
}

}  // namespace orchard::python
