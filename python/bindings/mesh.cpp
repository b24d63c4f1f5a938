// Meshes: read, checked, repaired, wrapped, asked, sampled.
#include <tbb/parallel_for.h>

#include <optional>

#include "construction.h"
#include "input/repair_distance.h"
#include "orchard/geometry/clip.h"
#include "orchard/geometry/mesh_details.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/self_intersections.h"
#include "orchard/geometry/surface_distance.h"
#include "orchard/geometry/unite.h"
#include "orchard/geometry/wrap.h"

namespace orchard::python {
namespace {

BoundingBall ball_named(const std::string& name) {
  return named<BoundingBall>("root_ball", name, {{"minimal", BoundingBall::minimal}, {"ritter", BoundingBall::ritter}});
}

SurfacePointer make_surface(const py::buffer& vertices, const py::buffer& triangles, const std::string& root_ball) {
  TriangleMesh mesh{.vertices = to_points(vertices),
                    .triangles = Input<std::uint32_t>(triangles, 3).rows<std::array<Index, 3>>()};
  const BoundingBall ball = ball_named(root_ball);
  const py::gil_scoped_release release;
  validate(mesh);
  require_usable_size(mesh);
  return std::make_shared<Surface>(std::move(mesh), ball);
}

py::tuple load(const std::filesystem::path& file, const std::string& root_ball) {
  const BoundingBall ball = ball_named(root_ball);
  SurfacePointer surface;
  MeshReadReport report;
  {
    const py::gil_scoped_release release;
    MeshReading reading = read_mesh_and_report(file);
    report = std::move(reading.report);
    surface = std::make_shared<Surface>(std::move(reading.mesh), ball);
  }
  return py::make_tuple(surface, report.lines(), report.faults());
}

py::dict inspect(const SurfacePointer& surface, bool self_intersections) {
  MeshDetails details;
  std::size_t cuts = 0;
  {
    const py::gil_scoped_release release;
    details = mesh_details(surface->mesh(), surface->report());
    if (self_intersections) cuts = surface->self_intersections().size();
  }
  const MeshReport& report = surface->report();
  py::dict result;
  result["vertices"] = report.vertices;
  result["triangles"] = report.triangles;
  result["components"] = report.components;
  result["euler_characteristic"] = report.euler_characteristic;
  result["genus"] = details.genus ? py::object(py::int_(*details.genus)) : py::object(py::none());
  result["solid"] = report.solid();
  result["faults"] = report.faults();
  result["boundary_edges"] = report.boundary_edges;
  result["boundary_loops"] = details.boundary_loops;
  result["non_manifold_edges"] = report.non_manifold_edges;
  result["non_manifold_vertices"] = report.non_manifold_vertices;
  result["misoriented_edges"] = report.misoriented_edges;
  result["degenerate_triangles"] = report.degenerate_triangles;
  result["duplicate_triangles"] = details.duplicate_triangles;
  result["coincident_vertices"] = details.coincident_vertices;
  result["unused_vertices"] = report.unused_vertices;
  result["inside_out_components"] = report.inside_out_components;
  result["area"] = report.area;
  result["volume"] = report.volume;
  result["self_intersections"] = self_intersections ? py::object(py::int_(cuts)) : py::object(py::none());
  return result;
}

// As the commands repair: the surface itself where nothing had to be done.
py::tuple repair(const SurfacePointer& surface, std::optional<double> join, std::optional<double> fill_holes,
                 py::object progress) {
  RepairMeshOptions options;
  if (join) options.join_distance = *join;
  if (fill_holes) {
    options.max_hole_diameter = *fill_holes;
    options.max_hole_edges = std::numeric_limits<Index>::max();
  }
  SurfacePointer repaired = surface;
  MeshRepairReport report;
  double distance = 0;
  watched(std::move(progress), [&](const Progress& watch) {
    report_progress(watch, "repair", 0);
    TriangleMesh mesh = surface->mesh();
    report = repair_mesh(mesh, options);
    if (!report.changed()) return 0;
    repaired = std::make_shared<Surface>(std::move(mesh), surface->ball_kind());
    distance = apps::repair_distance(surface->mesh(), *repaired, watch).upper();
    return 0;
  });
  py::dict result;
  result["solid"] = report.solid;
  result["faults"] = report.faults;
  result["lines"] = report.lines();
  result["distance"] = distance;
  result["holes_left"] = report.holes_left;
  result["max_hole_left"] = report.max_hole_left;
  return py::make_tuple(repaired, result);
}

py::tuple wrap(const SurfacePointer& surface, double alpha, double offset, py::object progress) {
  SurfaceDistance to_input, from_input;
  const SurfacePointer wrapped = watched(std::move(progress), [&](const Progress& watch) {
    report_progress(watch, "wrap", 0);
    auto result =
        std::make_shared<Surface>(wrap_mesh(surface->mesh(), {.alpha = alpha, .offset = offset}), surface->ball_kind());
    to_input = surface_distance(*result, *surface, {}, watch);
    from_input = surface_distance(*surface, *result, {}, watch);
    return result;
  });
  return py::make_tuple(wrapped, to_input.upper, from_input.upper);
}

SurfacePointer clip(const SurfacePointer& surface, const std::array<double, 3>& normal, double offset) {
  const HalfSpace kept{Vector(normal[0], normal[1], normal[2]), offset};
  const py::gil_scoped_release release;
  return std::make_shared<Surface>(clip_solid(surface->mesh(), kept), surface->ball_kind());
}

// Nothing where no parts cut each other, or no union can be made of them.
py::object unite(const SurfacePointer& surface, py::object progress) {
  std::optional<UnitedMesh> united;
  const SurfacePointer whole = watched(std::move(progress), [&](const Progress& watch) -> SurfacePointer {
    united = unite_parts(surface->mesh(), watch);
    if (!united) return nullptr;
    return std::make_shared<Surface>(std::move(united->mesh), surface->ball_kind());
  });
  if (!whole) return py::none();
  return py::make_tuple(whole, united->parts, united->cut_before, united->cut_left);
}

// In chunks, between which Ctrl-C is noticed; each on all processors.
template <class Work>
void for_each_point(std::size_t count, const Progress& progress, const Work& work) {
  constexpr std::size_t kChunk = 4096;
  for (std::size_t begin = 0; begin < count; begin += kChunk) {
    tbb::parallel_for(begin, std::min(count, begin + kChunk), work);
    report_progress(progress, "points", static_cast<double>(begin) / static_cast<double>(count));
  }
}

py::dict closest(const SurfacePointer& surface, const py::buffer& queries, bool with_sign, py::object progress) {
  const std::vector<Point> points = to_points(queries);
  std::vector<Point> positions(points.size());
  std::vector<double> distances(points.size());
  std::vector<Index> triangles(points.size());
  watched(std::move(progress), [&](const Progress& watch) {
    if (with_sign && !points.empty()) surface->signed_distance(points.front());  // prepares, or says why it cannot
    for_each_point(points.size(), watch, [&](std::size_t i) {
      ClosestPoint nearest;
      if (with_sign) {
        distances[i] = surface->signed_distance(points[i], nearest);
      } else {
        nearest = surface->closest(points[i]);
        distances[i] = nearest.distance;
      }
      positions[i] = nearest.position;
      triangles[i] = nearest.triangle;
    });
    return 0;
  });
  py::dict result;
  result["points"] = own_rows<double>(std::move(positions));
  result["distances"] = own(std::move(distances));
  result["triangles"] = own(std::move(triangles));
  return result;
}

Relaxation relaxation_named(const std::string& name) {
  return named<Relaxation>(
      "relaxation", name,
      {{"automatic", Relaxation::automatic}, {"clusters", Relaxation::clusters}, {"neighbors", Relaxation::neighbors}});
}

py::dict sample(const SurfacePointer& surface, Index samples, Index edge_samples, int iterations, std::uint64_t seed,
                const std::string& relaxation, std::optional<double> cluster_angle, std::optional<double> crease_angle,
                py::object progress) {
  SamplingOptions options{.face_points = samples - edge_samples,
                          .edge_points = edge_samples,
                          .iterations = iterations,
                          .seed = seed,
                          .relaxation = relaxation_named(relaxation)};
  if (cluster_angle) options.cluster_angle = *cluster_angle;
  if (crease_angle) options.crease_angle = *crease_angle;
  SurfaceSampling sampling = watched(std::move(progress), [&](const Progress& watch) {
    if (options.relaxation == Relaxation::automatic) options.relaxation = choose_relaxation(*surface, options);
    return sample_surface(*surface, options, watch);
  });
  std::vector<std::uint8_t> on_edge;
  on_edge.reserve(sampling.origins.size());
  for (const PointOrigin origin : sampling.origins) on_edge.push_back(origin == PointOrigin::edge ? 1 : 0);
  py::dict result;
  result["points"] = own_rows<double>(std::move(sampling.points));
  result["triangles"] = own(std::move(sampling.triangles));
  result["on_edge"] = own(std::move(on_edge));
  return result;
}

py::tuple bounding_box(const Surface& surface) {
  return py::make_tuple(to_array(surface.bounding_box().min()), to_array(surface.bounding_box().max()));
}

}  // namespace

void bind_mesh(py::module_& module) {
  py::class_<Surface, SurfacePointer>(module, "Surface", "A surface, immutable and shared by threads.")
      .def("vertices", [](const SurfacePointer& s) { return view_rows<double>(s, s->mesh().vertices); })
      .def("triangles", [](const SurfacePointer& s) { return view_rows<Index>(s, s->mesh().triangles); })
      .def("self_intersections",
           [](const SurfacePointer& s) {
             const py::gil_scoped_release release;
             return view_rows<Index>(s, s->self_intersections());
           })
      .def_property_readonly("solid", &Surface::solid)
      .def_property_readonly("faults", [](const Surface& s) { return s.report().faults(); })
      .def_property_readonly("area", [](const Surface& s) { return s.report().area; })
      .def_property_readonly("volume", [](const Surface& s) { return s.report().volume; })
      .def_property_readonly("bounding_radius", &Surface::bounding_radius)
      .def_property_readonly("bounding_center", [](const Surface& s) { return to_array(s.bounding_ball().center); })
      .def_property_readonly("bounding_box", &bounding_box)
      .def_property_readonly(
          "root_ball", [](const Surface& s) { return s.ball_kind() == BoundingBall::ritter ? "ritter" : "minimal"; });
  module.def("make_surface", &make_surface);
  module.def("load", &load);
  module.def("inspect", &inspect);
  module.def("repair", &repair);
  module.def("wrap", &wrap);
  module.def("clip", &clip);
  module.def("unite", &unite);
  module.def("closest", &closest);
  module.def("sample", &sample);
  module.def("write_obj", [](const std::filesystem::path& file, const SurfacePointer& surface) {
    const py::gil_scoped_release release;
    write_obj(file, surface->mesh());
  });
}

}  // namespace orchard::python
