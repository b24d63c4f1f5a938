// What is measured of medial axes, and what is made of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "medial/medial_measures.h"
#include "medial_types.h"
#include "orchard/medial/axis_distance.h"
#include "orchard/medial/envelope.h"
#include "orchard/medial/import_axis.h"
#include "orchard/medial/importance.h"
#include "orchard/medial/prune.h"
#include "orchard/medial/simplify.h"
#include "orchard/medial/topology.h"

namespace orchard::python {
namespace {

QualityOptions quality_options(Index samples, std::uint64_t seed) {
  QualityOptions options{.seed = seed};
  const auto scaled = [&](Index standard) {
    return std::max(Index{1}, static_cast<Index>(static_cast<double>(samples) / options.surface_samples * standard));
  };
  options.search = scaled(options.search);
  options.contact_cells = scaled(options.contact_cells);
  options.economy_candidates = scaled(options.economy_candidates);
  options.economy_samples = scaled(options.economy_samples);
  options.surface_samples = samples;
  return options;
}

py::list to_python(const std::vector<WorstPlace>& places) {
  constexpr std::array kNames{"protrusion", "coverage", "dent"};
  py::list list;
  for (const WorstPlace& place : places) {
    py::dict row;
    row["kind"] = kNames[static_cast<std::size_t>(place.kind)];
    row["value"] = 100 * place.value;
    row["position"] = to_array(place.position);
    list.append(row);
  }
  return list;
}

// Every measure by the name that it has in the command line's tables, where it is defined.
py::dict quality(const Axis& axis, Index samples, std::uint64_t seed, bool stability, py::object progress) {
  const QualityOptions options = quality_options(samples, seed);
  const apps::MedialJudgement judgement = watched(std::move(progress), [&](const Progress& watch) {
    apps::MedialJudgement found = apps::judge_mesh(*axis.surface, axis.mesh, options, watch);
    if (stability && axis.build)
      found.stability = medial_stability(*axis.surface, *axis.build, axis.options, {.seed = seed}, watch);
    return found;
  });
  py::dict measures, units;
  for (const apps::MedialMeasure& measure : apps::medial_measures()) {
    const double value = measure.get(judgement);
    if (std::isnan(value)) continue;
    measures[measure.name] = value;
    units[measure.name] = measure.unit;
  }
  py::dict result;
  result["measures"] = measures;
  result["units"] = units;
  result["diagonal"] = judgement.quality.diagonal;
  result["worst"] = to_python(judgement.quality.worst);
  return result;
}

py::dict errors_of_balls(const Axis& axis, bool centredness) {
  std::vector<Sphere> balls;
  balls.reserve(axis.mesh.size());
  for (Index i = 0; i < axis.mesh.size(); ++i) balls.push_back({axis.mesh.centers[i], axis.mesh.radii[i]});
  QualityOptions options;
  if (!centredness) options.contact_cells = 0;
  BallErrors errors;
  {
    const py::gil_scoped_release release;
    errors = ball_errors(*axis.surface, balls, options);
  }
  py::dict result;
  result["radius_error"] = own(std::move(errors.radius_error));
  result["protrusion"] = own(std::move(errors.protrusion));
  if (centredness) result["centredness"] = own(std::move(errors.centredness));
  return result;
}

py::tuple simplify(const AxisPointer& axis, Index vertices, double error, bool free_balls, std::uint64_t seed,
                   py::object progress) {
  const SimplifyOptions options{.vertices = vertices,
                                .error = error,
                                .balls = free_balls ? SimplifiedBalls::free : SimplifiedBalls::medial,
                                .seed = seed};
  SimplifyReport report;
  const AxisPointer few = watched(std::move(progress), [&](const Progress& watch) {
    SimplifiedMedialMesh result = simplify_medial_mesh(*axis->surface, axis->mesh, options, watch);
    report = result.report;
    return Axis::of_mesh(axis->surface, std::move(result.mesh));
  });
  py::dict said;
  said["vertices_before"] = report.vertices_before;
  said["vertices"] = report.vertices;
  said["hausdorff_max"] = 100 * report.hausdorff.max;
  said["coverage_max"] = 100 * report.coverage.max;
  said["protrusion_max"] = 100 * report.protrusion.max;
  said["upper"] = 100 * report.upper;
  return py::make_tuple(few, said);
}

// An axis that was not built here has no contacts; they are found from points of the surface.
// `limits` are the values by the names of the measures, in the library's units.
AxisPointer pruned(const AxisPointer& axis, const std::map<std::string, double>& limits, Index samples,
                   std::uint64_t seed, py::object progress) {
  PruneOptions options;
  for (const ImportanceMeasure measure : kImportanceMeasures) limit_of(options, measure) = limits.at(name_of(measure));
  return watched(std::move(progress), [&](const Progress& watch) {
    auto build = axis->build ? std::make_shared<MedialBuild>(*axis->build) : std::make_shared<MedialBuild>();
    if (!axis->build) {
      const SamplingOptions points{.face_points = samples - samples / 5, .edge_points = samples / 5, .seed = seed};
      ImportedAxis imported =
          import_axis(*axis->surface, axis->mesh, sample_surface(*axis->surface, points, watch), watch);
      build->axis = std::move(imported.axis);
      build->sampling = std::move(imported.sampling);
      build->points = samples;
    }
    build->axis = prune(*axis->surface, build->axis, options, watch);
    AxisPointer result = Axis::of_mesh(axis->surface, medial_mesh(build->axis));
    result->build = build;
    result->options = axis->options;
    return result;
  });
}

py::dict importance_of_balls(const Axis& axis, const std::vector<std::string>& names, const py::object& progress) {
  if (!axis.build) throw InputError("importance: the contacts of an axis that was not built here are not known");
  py::dict result;
  for (const ImportanceMeasure measure : kImportanceMeasures) {
    if (std::find(names.begin(), names.end(), name_of(measure)) == names.end()) continue;
    std::vector<double> values = watched(
        progress, [&](const Progress& watch) { return importance(*axis.surface, axis.build->axis, measure, watch); });
    values.resize(axis.mesh.centers.size(), std::numeric_limits<double>::quiet_NaN());  // middles of faces have none
    result[name_of(measure)] = own(std::move(values));
  }
  return result;
}

py::tuple envelope(const Axis& axis, double cell, py::object progress) {
  EnvelopeMesh found = watched(std::move(progress),
                               [&](const Progress& watch) { return envelope_mesh(axis.mesh, {.cell = cell}, watch); });
  return py::make_tuple(std::make_shared<Surface>(std::move(found.mesh)), found.lost);
}

py::dict to_python(const Topology& topology) {
  py::dict result;
  result["components"] = topology.components;
  result["loops"] = topology.loops;
  result["cavities"] = topology.cavities;
  return result;
}

py::dict distance(const Axis& a, const Axis& b, double accuracy) {
  AxisDistance found;
  {
    const py::gil_scoped_release release;
    found = axis_distance(a.mesh, b.mesh, accuracy);
  }
  py::dict result;
  result["max"] = found.max;
  result["max_gap"] = found.max_gap;
  result["mean"] = found.mean;
  result["max_from"] = found.max_from;
  result["max_to"] = found.max_to;
  return result;
}

}  // namespace

void bind_medial_measures(py::module_& module) {
  module.def("quality", &quality);
  module.def("ball_errors", &errors_of_balls);
  module.def("simplify", &simplify);
  module.def("prune", &pruned);
  module.def("importance", &importance_of_balls);
  module.def("envelope", &envelope);
  module.def("axis_distance", &distance);
  module.def("axis_topology", [](const Axis& axis) { return to_python(topology(axis.mesh)); });
  module.def("solid_topology", [](const Surface& surface) { return to_python(solid_topology(surface)); });
}

}  // namespace orchard::python
