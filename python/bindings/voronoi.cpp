// Voronoi diagrams of points.
#include "construction.h"
#include "orchard/voronoi/algorithms.h"
#include "orchard/voronoi/diagram_io.h"
#include "orchard/voronoi/quality.h"

namespace orchard::python {
namespace {

using Diagram = std::shared_ptr<VoronoiDiagram>;

py::tuple build(const py::buffer& sites, const std::string& algorithm, py::object progress) {
  const std::optional<VoronoiAlgorithm> chosen = voronoi_algorithm_named(algorithm);
  if (!chosen)
    throw py::value_error("algorithm: '" + algorithm + "' is not one of highest-first, inagaki, bowyer, exact");
  const std::vector<Point> points = to_points(sites);
  InsertionReport report;
  const Diagram diagram = watched(std::move(progress), [&](const Progress& watch) {
    VoronoiBuild result = voronoi(points, *chosen, watch);
    report = std::move(result.report);
    return std::make_shared<VoronoiDiagram>(std::move(result.diagram));
  });
  py::dict said;
  said["dimension"] = report.dimension;
  said["certified_insertions"] = report.certified_insertions;
  said["exact_insertions"] = report.exact_insertions;
  said["duplicates"] = own_rows<Index>(std::move(report.duplicates));
  return py::make_tuple(diagram, said);
}

Array vertex_field(const Diagram& diagram, const double* first, std::vector<py::ssize_t> shape) {
  std::vector<py::ssize_t> strides{sizeof(VoronoiVertex)};
  if (shape.size() > 1) strides.push_back(sizeof(double));
  return view(diagram, diagram->vertices.empty() ? nullptr : first, std::move(shape), std::move(strides));
}

Array index_field(const Diagram& diagram, const std::array<Index, 4> VoronoiVertex::*member) {
  const auto count = static_cast<py::ssize_t>(diagram->vertices.size());
  const Index* data = diagram->vertices.empty() ? nullptr : (diagram->vertices.front().*member).data();
  return view(diagram, data, {count, 4}, {sizeof(VoronoiVertex), sizeof(Index)});
}

py::tuple cells(const Diagram& diagram) {
  Rows rows = vertices_of_points(*diagram);
  return py::make_tuple(own(std::move(rows.offsets)), own(std::move(rows.items)));
}

py::tuple faces(const Diagram& diagram) {
  VoronoiFaces found = voronoi_faces(*diagram);
  return py::make_tuple(own_rows<Index>(std::move(found.points)), own(std::move(found.vertices.offsets)),
                        own(std::move(found.vertices.items)));
}

py::dict inaccuracy_of(const Diagram& diagram, py::object progress) {
  const VoronoiInaccuracies found =
      watched(std::move(progress), [&](const Progress& watch) { return inaccuracies(*diagram, watch); });
  py::dict result;
  result["mean"] = found.segments.mean;
  result["max"] = found.segments.max;
  result["corner_mean"] = found.corners.mean;
  result["corner_max"] = found.corners.max;
  return result;
}

}  // namespace

void bind_voronoi(py::module_& module) {
  py::class_<VoronoiDiagram, Diagram>(module, "VoronoiDiagram")
      .def("sites", [](const Diagram& d) { return view_rows<double>(d, d->points); })
      .def("vertices",
           [](const Diagram& d) {
             const auto count = static_cast<py::ssize_t>(d->vertices.size());
             return vertex_field(d, d->vertices.empty() ? nullptr : d->vertices.front().center.data(), {count, 3});
           })
      .def("radii",
           [](const Diagram& d) {
             const auto count = static_cast<py::ssize_t>(d->vertices.size());
             return vertex_field(d, d->vertices.empty() ? nullptr : &d->vertices.front().radius, {count});
           })
      .def("forming_sites", [](const Diagram& d) { return index_field(d, &VoronoiVertex::forming_points); })
      .def("neighbors", [](const Diagram& d) { return index_field(d, &VoronoiVertex::neighbors); })
      .def("cells", &cells)
      .def("faces", &faces)
      .def("inaccuracy", &inaccuracy_of)
      .def("to_vor", [](const Diagram& d) { return to_vor(*d); });
  module.def("voronoi", &build);
  module.def("read_vor", [](const std::filesystem::path& file) {
    const py::gil_scoped_release release;
    return std::make_shared<VoronoiDiagram>(read_vor(file));
  });
}

}  // namespace orchard::python
