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

// Rows of a ball or a box and a factor, as parse_weight() has them on the command line.
SetWeights weights_of(const py::buffer& balls, const py::buffer& boxes, const py::buffer& of_vertices) {
  SetWeights weights;
  const Input<double> of_balls(balls, 5), of_boxes(boxes, 7), factors(of_vertices, 0);
  for (std::size_t i = 0; i < of_balls.size(); ++i) {
    const double* row = of_balls.row(i);
    weights.regions.push_back({Sphere{Point(row[0], row[1], row[2]), row[3]}, row[4]});
  }
  for (std::size_t i = 0; i < of_boxes.size(); ++i) {
    const double* row = of_boxes.row(i);
    Box box(Point(row[0], row[1], row[2]));
    box.extend(Point(row[3], row[4], row[5]));
    weights.regions.push_back({box, row[6]});
  }
  for (std::size_t i = 0; i < factors.size(); ++i) weights.of_vertices.push_back(*factors.row(i));
  return weights;
}

ParticleOptions particles_of(const py::dict& given) {
  ParticleOptions options;
  options.overlap = given["overlap"].cast<double>();
  options.equal_radii = given["equal"].cast<bool>();
  options.density = given["density"].cast<double>();
  options.density_of = named<ParticleOptions::DensityOf>(
      "density_of", given["density_of"].cast<std::string>(),
      {{"solid", ParticleOptions::DensityOf::solid}, {"balls", ParticleOptions::DensityOf::balls}});
  options.own_masses = given["masses"].cast<bool>();
  options.center_error = given["center_error"].cast<double>();
  options.inertia_error = given["inertia_error"].cast<double>();
  return options;
}

SphereSetOptions options_of(const py::dict& given) {
  SphereSetOptions options{.spheres = given["spheres"].cast<Index>(),
                           .error = given["error"].cast<double>(),
                           .volume_error = given["volume_error"].cast<double>(),
                           .solid = given["solid"].cast<bool>(),
                           .padding = given["padding"].cast<double>(),
                           .min_radius = given["min_radius"].cast<double>(),
                           .effort = effort_named(given["effort"].cast<std::string>()),
                           .seed = given["seed"].cast<std::uint64_t>()};
  options.fit = named<SphereFit>("fit", given["fit"].cast<std::string>(),
                                 {{"cover", SphereFit::cover},
                                  {"inside", SphereFit::inside},
                                  {"balanced", SphereFit::balanced},
                                  {"particles", SphereFit::particles}});
  return options;
}

py::dict to_python(const ParticleFigures& figures) {
  py::dict result;
  result["masses"] = figures.masses;
  result["body"] = mass(figures.body);
  result["wanted_mass"] = figures.wanted_mass;
  result["center_error"] = figures.center_error;
  result["inertia_error"] = figures.inertia_error;
  result["largest_overlap"] = figures.largest_overlap;
  result["overlap_proven"] = figures.overlap_proven;
  result["filled"] = figures.filled;
  return result;
}

py::dict build(const SurfacePointer& surface, const py::dict& given, const py::dict& particles, const py::buffer& balls,
               const py::buffer& boxes, const py::buffer& of_vertices, py::object progress) {
  SphereSetOptions options = options_of(given);
  options.particles = particles_of(particles);
  options.weights = weights_of(balls, boxes, of_vertices);
  require_usable(options);
  const SphereSetBuild found =
      watched(std::move(progress), [&](const Progress& watch) { return build_sphere_set(*surface, options, watch); });
  py::dict result;
  result["spheres"] = own_rows<double>(to_rows(found.spheres));
  result["kept"] = found.kept;
  result["error_reached"] = found.error_reached;
  result["enough"] = found.enough ? py::cast(*found.enough) : py::none();
  result["particles"] = found.particles ? py::object(to_python(*found.particles)) : py::none();
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
