// The local thickness of a solid.
#include "orchard/medial/thickness.h"
#include "construction.h"

namespace orchard::python {
namespace {

ThicknessOptions options_of(const std::string& definition, double facing, double smooth, Index samples) {
  ThicknessOptions options{.facing = facing, .smooth = smooth, .samples = samples};
  options.definition = named<ThicknessDefinition>(
      "definition", definition, {{"ball", ThicknessDefinition::ball}, {"ray", ThicknessDefinition::ray}});
  return options;
}

// At the places of the surface that are nearest to points.
py::dict thickness_at_points(const SurfacePointer& surface, const py::buffer& queries, const std::string& definition,
                             double facing, double smooth, py::object progress) {
  const std::vector<Point> points = to_points(queries);
  const ThicknessOptions options = options_of(definition, facing, smooth, 1);
  auto found = watched(std::move(progress), [&](const Progress& watch) {
    std::vector<SurfacePlace> places;
    places.reserve(points.size());
    for (const Point& point : points) {
      const ClosestPoint nearest = surface->closest(point);
      places.push_back({nearest.position, nearest.triangle, nearest.feature});
    }
    return std::make_shared<const std::vector<ThicknessAt>>(thickness_at(*surface, places, options, watch));
  });
  py::dict result;
  result["thickness"] = field<double>(found, &ThicknessAt::thickness);
  result["ball_diameter"] = field<double>(found, &ThicknessAt::diameter);
  result["error"] = field<double>(found, &ThicknessAt::error);
  result["contact"] = field<double>(found, &ThicknessAt::contact);
  result["contact_angle"] = field<double>(found, &ThicknessAt::angle);
  result["normal"] = field<double>(found, &ThicknessAt::normal);
  return result;
}

py::dict values_of(const std::shared_ptr<const LocalThickness>& owner, const ThicknessValues& values) {
  py::dict result;
  result["thickness"] = view_rows<double>(owner, values.thickness);
  result["ball_diameter"] = view_rows<double>(owner, values.ball_diameter);
  result["contact_angle"] = view_rows<double>(owner, values.contact_angle);
  result["error"] = view_rows<double>(owner, values.error);
  result["contact"] = view_rows<double>(owner, values.contacts);
  return result;
}

py::dict thickness_of(const SurfacePointer& surface, const std::string& definition, double facing, double smooth,
                      Index samples, py::object progress) {
  const ThicknessOptions options = options_of(definition, facing, smooth, samples);
  const auto found = watched(std::move(progress), [&](const Progress& watch) {
    return std::make_shared<LocalThickness>(local_thickness(*surface, options, watch));
  });
  py::dict result;
  result["vertices"] = view_rows<double>(found, found->mesh.vertices);
  result["faces"] = view_rows<Index>(found, found->mesh.triangles);
  result["of_face"] = view_rows<Index>(found, found->of_triangle);
  result["at_vertices"] = values_of(found, found->at_vertices);
  result["at_faces"] = values_of(found, found->at_triangles);
  result["handle"] = found;
  return result;
}

py::dict thin_places(const std::shared_ptr<LocalThickness>& thickness, double below) {
  const ThinRegions regions = thin_regions(*thickness, below);
  py::list list;
  for (const ThinRegion& region : regions.regions) {
    py::dict row;
    row["area"] = region.area;
    row["min_thickness"] = region.min_thickness;
    row["thinnest"] = to_array(region.thinnest);
    row["faces"] = region.triangles;
    list.append(row);
  }
  py::dict result;
  result["area"] = regions.area;
  result["defined_area"] = regions.defined_area;
  result["total_area"] = regions.total_area;
  result["regions"] = list;
  result["of_face"] = own(regions.of_triangle);
  return result;
}

}  // namespace

void bind_thickness(py::module_& module) {
  const py::class_<LocalThickness, std::shared_ptr<LocalThickness>> without_members(module, "LocalThickness");
  module.def("thickness_at", &thickness_at_points);
  module.def("thickness", &thickness_of);
  module.def("thin_places", &thin_places);
}

}  // namespace orchard::python
