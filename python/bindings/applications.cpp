// What is made of solids and their medial axes: curve skeletons, parts of the surface, offsets.
#include "medial_types.h"
#include "orchard/medial/curve_skeleton.h"
#include "orchard/medial/offset.h"
#include "orchard/medial/surface_parts.h"
#include "orchard/medial/topology.h"

namespace orchard::python {
namespace {

using SkeletonPointer = std::shared_ptr<CurveSkeleton>;
using PartsPointer = std::shared_ptr<SurfaceParts>;

SkeletonPointer skeleton_of(const Axis& axis, double erosion, double ratio, double edge_length, int smoothing,
                            py::object progress) {
  const SkeletonOptions options{.erosion = erosion, .ratio = ratio, .edge_length = edge_length, .smoothing = smoothing};
  return watched(std::move(progress), [&](const Progress& watch) {
    return std::make_shared<CurveSkeleton>(curve_skeleton(*axis.surface, axis.mesh, options, watch));
  });
}

py::list skeleton_arcs(const SkeletonPointer& skeleton) {
  py::list list;
  for (const CurveSkeleton::Arc& arc : skeleton->arcs) {
    py::dict row;
    row["start"] = arc.from;
    row["end"] = arc.to;
    row["length"] = arc.length;
    row["min_radius"] = arc.min_radius;
    row["mean_radius"] = arc.mean_radius;
    row["significance"] = arc.significance;
    row["of_axis"] = arc.of_axis;
    row["vertices"] = view_rows<Index>(skeleton, arc.vertices);
    list.append(row);
  }
  return list;
}

std::string skeleton_text(const CurveSkeleton& skeleton, const std::string& format) {
  if (format == "swc") return to_swc(skeleton);
  if (format == "graphml") return to_graphml(skeleton);
  if (format == "obj") return to_obj(skeleton);
  if (format == "csv") return to_csv(skeleton);
  throw py::value_error("format: '" + format + "' is not one of swc, graphml, obj, csv");
}

std::map<std::string, std::int64_t> skeleton_topology(const CurveSkeleton& skeleton) {
  const Topology found = topology(medial_mesh(skeleton));
  return {{"components", found.components}, {"loops", found.loops}, {"cavities", found.cavities}};
}

PartsPointer parts_of(const Axis& axis, const std::string& kind, double neck, double min_area, Index samples,
                      int smoothing, py::object progress) {
  PartOptions options{.neck = neck, .min_area = min_area, .samples = samples, .smoothing = smoothing};
  options.kind =
      named<PartKind>("by", kind, {{"both", PartKind::both}, {"sheets", PartKind::sheets}, {"necks", PartKind::necks}});
  return watched(std::move(progress), [&](const Progress& watch) {
    return std::make_shared<SurfaceParts>(surface_parts(*axis.surface, axis.mesh, options, watch));
  });
}

py::object number_or_none(Index index) { return index == kNone ? py::object(py::none()) : py::object(py::int_(index)); }

py::list part_rows(const SurfaceParts& parts) {
  py::list list;
  for (const SurfaceParts::Part& part : parts.parts) {
    py::dict row;
    row["area"] = part.area;
    row["faces"] = part.triangles;
    row["patches"] = part.patches;
    row["max_radius"] = part.max_radius;
    row["sheet"] = number_or_none(part.sheet);
    row["region"] = number_or_none(part.region);
    list.append(row);
  }
  return list;
}

py::list neck_rows(const SurfaceParts& parts) {
  py::list list;
  for (const SurfaceParts::Neck& neck : parts.necks) {
    py::dict row;
    row["regions"] = py::make_tuple(neck.a, neck.b);
    row["place"] = to_array(neck.place);
    row["radius"] = neck.radius;
    row["significance"] = neck.significance;
    list.append(row);
  }
  return list;
}

SurfacePointer surface_of(TriangleMesh mesh) { return std::make_shared<Surface>(std::move(mesh)); }

py::dict offset_to_python(const OffsetMesh& offset, const SurfacePointer& mesh) {
  py::dict result;
  result["mesh"] = mesh;
  result["distance"] = offset.distance;
  result["tolerance"] = offset.tolerance;
  result["cell"] = offset.cell;
  result["min_distance"] = offset.min_distance;
  result["max_distance"] = offset.max_distance;
  result["nearest"] = to_array(offset.nearest);
  result["farthest"] = to_array(offset.farthest);
  return result;
}

py::dict offset_of(const SurfacePointer& surface, double distance, const std::string& side, double tolerance,
                   py::object progress) {
  OffsetOptions options{.distance = distance, .tolerance = tolerance};
  options.side = named<OffsetSide>(
      "side", side, {{"outside", OffsetSide::outside}, {"inside", OffsetSide::inside}, {"both", OffsetSide::both}});
  SurfacePointer made;
  const OffsetMesh offset = watched(std::move(progress), [&](const Progress& watch) {
    OffsetMesh found = offset_mesh(*surface, options, watch);
    made = surface_of(std::move(found.mesh));
    return found;
  });
  return offset_to_python(offset, made);
}

py::dict hollow(const SurfacePointer& surface, double wall, double tolerance, py::object progress) {
  const OffsetOptions options{.tolerance = tolerance};
  SurfacePointer made;
  const HollowMesh found = watched(std::move(progress), [&](const Progress& watch) {
    HollowMesh hollowed = hollow_mesh(*surface, wall, options, watch);
    made = surface_of(std::move(hollowed.mesh));
    return hollowed;
  });
  py::dict result = offset_to_python(found.cavity, made);
  result["min_wall"] = found.min_wall;
  return result;
}

void bind_skeleton(py::module_& module) {
  py::class_<CurveSkeleton, std::shared_ptr<CurveSkeleton>>(module, "CurveSkeleton")
      .def("vertices", [](const SkeletonPointer& s) { return view_rows<double>(s, s->vertices); })
      .def("radii", [](const SkeletonPointer& s) { return view_rows<double>(s, s->radii); })
      .def("burn_times", [](const SkeletonPointer& s) { return view_rows<double>(s, s->burn_times); })
      .def("edges", [](const SkeletonPointer& s) { return view_rows<Index>(s, s->edges); })
      .def("nodes", [](const SkeletonPointer& s) { return view_rows<Index>(s, s->nodes); })
      .def("sheets", [](const SkeletonPointer& s) { return view_rows<Index>(s, s->sheets); })
      .def("arcs", &skeleton_arcs)
      .def("bounds", [](const CurveSkeleton& s) { return py::make_tuple(s.edge_length, s.max_moved, s.axis_distance); })
      .def("topology", &skeleton_topology)
      .def("text", &skeleton_text);
  module.def("skeleton", &skeleton_of);
}

}  // namespace

void bind_applications(py::module_& module) {
  bind_skeleton(module);
  py::class_<SurfaceParts, std::shared_ptr<SurfaceParts>>(module, "SurfaceParts")
      .def("mesh", [](const SurfaceParts& parts) { return surface_of(parts.mesh); })
      .def("of_face", [](const PartsPointer& p) { return view_rows<Index>(p, p->of_triangle); })
      .def("part_of_face", [](const PartsPointer& p) { return view_rows<Index>(p, p->parts_of); })
      .def("radii", [](const PartsPointer& p) { return view_rows<double>(p, p->radii); })
      .def("parts", &part_rows)
      .def("necks", &neck_rows)
      .def("regions", [](const SurfaceParts& parts) { return parts.regions; })
      .def("part_mesh", [](const SurfaceParts& parts, Index part) { return surface_of(part_mesh(parts, part)); });
  module.def("surface_parts", &parts_of);
  module.def("offset", &offset_of);
  module.def("hollow", &hollow);
}

}  // namespace orchard::python
