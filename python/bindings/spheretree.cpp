// Certified sphere-trees: built, verified, measured. A tree goes to Python as the bytes of its .orchard file, which the
// run-time's module reads; so the two modules share no C++ type.
#include <optional>

#include "medial_types.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/build.h"
#include "orchard/spheretree/certify.h"
#include "orchard/spheretree/pack.h"
#include "orchard/spheretree/tree_io.h"

namespace orchard::python {
namespace {

using runtime::PackedSphereTree;

template <class Value>
void set(const py::dict& options, const char* name, Value& value) {
  if (options.contains(name)) value = options[name].cast<std::remove_cvref_t<Value>>();
}
template <class Value>
void set_named(const py::dict& options, const char* name, Value& value,
               const std::vector<std::pair<const char*, Value>>& names) {
  if (options.contains(name)) value = named<Value>(name, options[name].cast<std::string>(), names);
}

void set_annealing(const py::dict& options, AnnealingTuning& tuning) {
  set(options, "anneal_move", tuning.move);
  set(options, "anneal_min_scale", tuning.min_scale);
  set(options, "anneal_max_scale", tuning.max_scale);
  set(options, "anneal_first_trials", tuning.first_trials);
  set(options, "anneal_first_acceptance", tuning.first_acceptance);
  set(options, "anneal_max_accepted", tuning.max_accepted);
  set(options, "anneal_max_rejected", tuning.max_rejected);
  set(options, "anneal_max_uncovering", tuning.max_uncovering);
  set(options, "anneal_cooling", tuning.cooling);
  set(options, "anneal_first_iterations", tuning.iterations_first);
  set(options, "anneal_iterations", tuning.iterations);
}

// The options of `orchard build`, by name; those that are not in the dictionary are standard.
SphereTreeOptions to_options(const py::dict& given, Tuning tuning, bool from_axis, bool within_time) {
  SphereTreeOptions options;
  set_named(given, "method", options.method,
            {{"tightened", TreeMethod::tightened},
             {"merging", TreeMethod::merging},
             {"annealing", TreeMethod::annealing},
             {"octree", TreeMethod::octree}});
  set(given, "depth", options.depth);
  set(given, "branching", options.branching);
  set(given, "spheres", options.spheres);
  if (!options.spheres.empty()) options.depth = static_cast<Index>(options.spheres.size());
  set_named(given, "effort", options.effort,
            {{"low", Effort::low}, {"default", Effort::standard}, {"high", Effort::high}});
  set_named(given, "objective", options.objective,
            {{"balanced", Objective::balanced},
             {"maximum", Objective::maximum},
             {"mean", Objective::mean},
             {"volume", Objective::volume}});
  set_named(given, "closing", options.closing, {{"refit", MergeClosing::refit}, {"growth", MergeClosing::growth}});
  set_named(given, "energy", options.energy, {{"maximum", SetEnergy::maximum}, {"sum", SetEnergy::sum}});
  set_named(given, "anneal_distance", options.distance,
            {{"lemma", SphereEnergy::lemma},
             {"samples", SphereEnergy::samples},
             {"corrected-samples", SphereEnergy::corrected_samples}});
  set_named(given, "redundant", options.redundancy,
            {{"independent", Selection::independent},
             {"acyclic", Selection::acyclic},
             {"exhaustive", Selection::exhaustive}});
  set(given, "descent", options.descent);
  set(given, "anneal", options.anneal);
  set(given, "error", options.refinement.error);
  set_annealing(given, options.annealing);
  if (given.contains("regions")) {
    for (const auto& [x, y, z, r, e] :
         given["regions"].cast<std::vector<std::tuple<double, double, double, double, double>>>())
      options.refinement.regions.push_back({{Point(x, y, z), r}, e});
  }
  // As the command does: a tightened tree needs no axis, others a raw one; points by need unless they are given.
  const bool samples_given = tuning.contains("samples");
  options.samples_by_need = within_time && !samples_given;
  tuning["refine"] = "no";
  if (!samples_given) tuning["samples"] = std::to_string(samples_needed(options));
  options.medial = to_build_options(tuning);
  options.seed = options.medial.sampling.seed;
  options.axis = from_axis;
  require_sizes(options);
  return options;
}

py::bytes bytes_of(const PackedSphereTree& tree) {
  const std::vector<std::byte> bytes = runtime::serialize(tree);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

PackedSphereTree tree_of(const py::buffer& bytes) {
  const Input<std::uint8_t> input(bytes, 0);
  PackedSphereTree tree;
  const auto status = runtime::load(std::as_bytes(std::span(input.row(0), input.size())), tree);
  if (status != runtime::LoadStatus::ok) throw py::value_error(runtime::message(status));
  return tree;
}

py::dict to_python(const Verification& found) {
  constexpr std::array kNames{"uncovered", "unlisted", "other_mesh", "center_distance", "distance_bound"};
  py::list violations;
  for (const Violation& violation : found.violations) {
    py::dict row;
    row["kind"] = kNames[static_cast<std::size_t>(violation.kind)];
    row["node"] = violation.node == kNone ? std::int64_t{-1} : std::int64_t{violation.node};
    row["triangle"] = violation.triangle == kNone ? std::int64_t{-1} : std::int64_t{violation.triangle};
    row["point"] = to_array(violation.point);
    row["amount"] = violation.amount;
    violations.append(row);
  }
  py::dict result;
  result["ok"] = found.ok();
  result["same_mesh"] = found.same_mesh;
  result["triangles"] = found.triangles;
  result["triangles_uncovered"] = found.triangles_uncovered;
  result["triangles_unlisted"] = found.triangles_unlisted;
  result["nodes"] = found.nodes;
  result["bounds_violated"] = found.bounds_violated;
  result["violations"] = violations;
  return result;
}

py::list levels_of(const SphereTree& tree, double radius) {
  py::list levels;
  for (const LevelFigures& level : level_figures(tree, radius)) {
    py::dict row;
    row["spheres"] = level.spheres;
    row["mean_inaccuracy"] = level.mean_inaccuracy;
    row["max_inaccuracy"] = level.max_inaccuracy;
    levels.append(row);
  }
  return levels;
}

MedialBuildInput to_input(const Surface& surface, const py::object& points, const AxisPointer& axis) {
  MedialBuildInput input;
  if (!points.is_none()) input.sampling = own_sampling(surface, points);
  if (axis) input.mesh = axis->mesh;
  return input;
}

py::dict build(const SurfacePointer& surface, const py::dict& given, const Tuning& tuning, const py::object& points,
               const AxisPointer& axis, std::optional<double> seconds, py::object progress) {
  const SphereTreeOptions options = to_options(given, tuning, axis != nullptr, seconds.has_value());
  MedialBuildInput input = to_input(*surface, points, axis);
  const SphereTreeBuild found = watched(std::move(progress), [&](const Progress& watch) {
    return seconds ? build_sphere_tree_within(*seconds, *surface, options, watch, input)
                   : build_sphere_tree(*surface, options, watch, std::move(input));
  });
  py::dict times;
  for (const auto& [stage, time] : found.seconds) times[py::str(stage)] = time;
  py::dict result;
  result["bytes"] = bytes_of(found.packed);
  result["sph"] = to_sph(found.tree);
  result["certificate"] = to_python(found.certificate);
  result["levels"] = levels_of(found.tree, surface->bounding_radius());
  result["points"] = found.points;
  result["seconds"] = times;
  return result;
}

py::dict verified(const SurfacePointer& surface, const py::buffer& bytes, py::object progress) {
  const PackedSphereTree tree = tree_of(bytes);
  return to_python(
      watched(std::move(progress), [&](const Progress& watch) { return verify(*surface, tree, {}, watch); }));
}

// A .sph file of any system, packed for a surface, whose bounds are measured.
py::dict read_sph_tree(const SurfacePointer& surface, const std::filesystem::path& file) {
  std::string text;
  PackedSphereTree packed;
  Verification certificate;
  {
    const py::gil_scoped_release release;
    const SphereTree tree = read_sph(file);
    text = to_sph(tree);
    packed = pack(tree, *surface);
    certificate = verify(*surface, packed);
  }
  py::dict result;
  result["bytes"] = bytes_of(packed);
  result["sph"] = text;
  result["certificate"] = to_python(certificate);
  return result;
}

}  // namespace

void bind_spheretree(py::module_& module) {
  module.def("sphere_tree", &build);
  module.def("verify", &verified);
  module.def("read_sph", &read_sph_tree);
  module.def("to_sph", [](const py::buffer& bytes) { return to_sph(unpack(tree_of(bytes))); });
}

}  // namespace orchard::python
