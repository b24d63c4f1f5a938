// Sets of spheres with a promise, and what sets of any origin are beside a mesh.
#include "construction.h"
#include "orchard/spheretree/sphere_set.h"

namespace orchard::python {
namespace {

std::vector<Sphere> to_spheres(const py::buffer& rows) {
  const Input<double> input(rows, 4);
  std::vector<Sphere> spheres(input.size());
  for (std::size_t i = 0; i < spheres.size(); ++i) {
    const double* s = input.row(i);
    spheres[i] = {Point(s[0], s[1], s[2]), s[3]};
  }
  return spheres;
}

std::vector<std::array<double, 4>> to_rows(const std::vector<Sphere>& spheres) {
  std::vector<std::array<double, 4>> rows;
  rows.reserve(spheres.size());
  for (const Sphere& s : spheres) rows.push_back({s.center.x(), s.center.y(), s.center.z(), s.radius});
  return rows;
}

py::tuple bounds(const Bounds& bounds) { return py::make_tuple(bounds.lower, bounds.upper); }

py::dict mass(const MassProperties& properties) {
  const Eigen::Matrix3d& m = properties.inertia;
  py::dict result;
  result["volume"] = properties.volume;
  result["center"] = to_array(properties.center);
  result["inertia"] = std::array{std::array{m(0, 0), m(0, 1), m(0, 2)}, std::array{m(1, 0), m(1, 1), m(1, 2)},
                                 std::array{m(2, 0), m(2, 1), m(2, 2)}};
  return result;
}

void add_solid(const SphereAudit::BesideSolid& beside, py::dict& result) {
  result["protrusion"] = bounds(beside.protrusion);
  result["protruding"] = beside.protruding == kNone ? std::int64_t{-1} : std::int64_t{beside.protruding};
  result["solid_volume"] = beside.volume.solid;
  result["union_volume"] = beside.volume.balls.value;
  result["outside_volume"] = beside.volume.outside.value;
  result["uncovered_volume"] = beside.volume.uncovered.value;
  result["mean_protrusion"] = beside.mean.protrusion;
  result["mean_gap"] = beside.mean.gap;
  result["two_sided_mean"] = beside.mean.two_sided();
  result["of_union"] = mass(beside.volume.of_balls);
  result["of_solid"] = mass(beside.volume.of_solid);
  const CuroboFigures& figures = beside.curobo;
  py::dict curobo;
  curobo["num_spheres"] = figures.num_spheres;
  curobo["coverage"] = figures.coverage;
  curobo["protrusion"] = figures.protrusion;
  curobo["protrusion_dist_mean"] = figures.protrusion_dist_mean;
  curobo["protrusion_dist_p95"] = figures.protrusion_dist_p95;
  curobo["surface_gap_mean"] = figures.surface_gap_mean;
  curobo["surface_gap_p95"] = figures.surface_gap_p95;
  curobo["max_uncovered_gap"] = figures.max_uncovered_gap;
  curobo["volume_ratio"] = figures.volume_ratio;
  result["curobo"] = curobo;
}

py::dict to_python(const SphereAudit& audit) {
  py::dict result;
  result["spheres"] = audit.spheres;
  result["covered"] = audit.covered;
  result["touches"] = audit.touches;
  result["area"] = audit.area;
  result["open_area"] = bounds(audit.open_area);
  result["likely_open_area"] = audit.likely_open_area;
  result["largest_gap"] = bounds(audit.largest_gap);
  result["gap_place"] = to_array(audit.gap_place);
  if (audit.beside_solid) add_solid(*audit.beside_solid, result);
  return result;
}

Effort effort_named(const std::string& name) {
  return named<Effort>("effort", name, {{"low", Effort::low}, {"default", Effort::standard}, {"high", Effort::high}});
}

py::dict build(const SurfacePointer& surface, Index spheres, const std::string& fit, double error, double volume_error,
               bool solid, double padding, double min_radius, const std::string& effort, std::uint64_t seed,
               py::object progress) {
  SphereSetOptions options{.spheres = spheres,
                           .error = error,
                           .volume_error = volume_error,
                           .solid = solid,
                           .padding = padding,
                           .min_radius = min_radius,
                           .effort = effort_named(effort),
                           .seed = seed};
  options.fit = named<SphereFit>(
      "fit", fit, {{"cover", SphereFit::cover}, {"inside", SphereFit::inside}, {"balanced", SphereFit::balanced}});
  require_usable(options);
  const SphereSetBuild found =
      watched(std::move(progress), [&](const Progress& watch) { return build_sphere_set(*surface, options, watch); });
  py::dict result;
  result["spheres"] = own_rows<double>(to_rows(found.spheres));
  result["kept"] = found.kept;
  result["error_reached"] = found.error_reached;
  result["audit"] = to_python(found.audit);
  return result;
}

py::dict audit(const SurfacePointer& surface, const py::buffer& rows, std::uint64_t seed, py::object progress) {
  const std::vector<Sphere> spheres = to_spheres(rows);
  return to_python(watched(std::move(progress), [&](const Progress& watch) {
    return audit_spheres(*surface, spheres, {.seed = seed}, watch);
  }));
}

}  // namespace

void bind_sets(py::module_& module) {
  module.def("sphere_set", &build);
  module.def("audit", &audit);
}

}  // namespace orchard::python
