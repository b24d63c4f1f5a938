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

Effort effort_of(const py::dict& given) {
  Effort effort = Effort::standard;
  set_named(given, "effort", effort, {{"low", Effort::low}, {"default", Effort::standard}, {"high", Effort::high}});
  return effort;
}

Refinement refinement_of(const py::dict& given) {
  Refinement refinement;
  set(given, "error", refinement.error);
  if (!given.contains("regions")) return refinement;
  for (const auto& [x, y, z, r, e] :
       given["regions"].cast<std::vector<std::tuple<double, double, double, double, double>>>())
    refinement.regions.push_back({{Point(x, y, z), r}, e});
  return refinement;
}

// What the builders have in common.
template <class Options>
void set_common(const py::dict& given, Options& options) {
  set(given, "depth", options.depth);
  set(given, "branching", options.branching);
  options.refinement = refinement_of(given);
}

AnnealingOptions to_annealing(const py::dict& given, Selection redundancy, double first_acceptance) {
  AnnealingOptions options = annealing_options(effort_of(given));
  set_common(given, options);
  set_named(given, "energy", options.energy, {{"maximum", SetEnergy::maximum}, {"sum", SetEnergy::sum}});
  set_named(given, "anneal_distance", options.distance,
            {{"lemma", SphereEnergy::lemma},
             {"samples", SphereEnergy::samples},
             {"corrected-samples", SphereEnergy::corrected_samples}});
  options.first_acceptance = first_acceptance;
  set(given, "anneal_move", options.move);
  set(given, "anneal_min_scale", options.min_scale);
  set(given, "anneal_max_scale", options.max_scale);
  set(given, "anneal_first_trials", options.first_trials);
  set(given, "anneal_first_acceptance", options.first_acceptance);
  set(given, "anneal_max_accepted", options.max_accepted);
  set(given, "anneal_max_rejected", options.max_rejected);
  set(given, "anneal_max_uncovering", options.max_uncovering);
  set(given, "anneal_cooling", options.cooling);
  set(given, "anneal_first_iterations", options.iterations_first);
  set(given, "anneal_iterations", options.iterations);
  if (redundancy == Selection::independent) options.redundancy = redundancy;
  return options;
}

TightenOptions to_tightening(const py::dict& given) {
  TightenOptions options;
  set_common(given, options);
  set(given, "spheres", options.spheres);
  if (!options.spheres.empty()) options.depth = static_cast<Index>(options.spheres.size());
  options.effort = effort_of(given);
  set_named(given, "objective", options.objective,
            {{"balanced", Objective::balanced},
             {"maximum", Objective::maximum},
             {"mean", Objective::mean},
             {"volume", Objective::volume}});
  return options;
}

MergeOptions to_merging(const py::dict& given) {
  MergeOptions options;
  set_common(given, options);
  set_named(given, "closing", options.closing, {{"refit", MergeClosing::refit}, {"growth", MergeClosing::growth}});
  return options;
}

OctreeOptions to_octree(const py::dict& given) {
  OctreeOptions options;
  set_common(given, options);
  return options;
}

TreeOptions to_builder(const py::dict& given, Selection redundancy) {
  TreeMethod method = TreeMethod::tightened;
  set_named(given, "method", method,
            {{"tightened", TreeMethod::tightened},
             {"merging", TreeMethod::merging},
             {"annealing", TreeMethod::annealing},
             {"octree", TreeMethod::octree}});
  if (method == TreeMethod::merging) return to_merging(given);
  if (method == TreeMethod::annealing) return to_annealing(given, redundancy, AnnealingOptions{}.first_acceptance);
  if (method == TreeMethod::octree) return to_octree(given);
  return to_tightening(given);
}

// One seed for all random choices.
void set_seed(SphereTreeOptions& options, std::uint64_t seed) {
  if (auto* tightening = std::get_if<TightenOptions>(&options.tree)) tightening->seed = seed;
  if (auto* annealing = std::get_if<AnnealingOptions>(&options.tree)) annealing->seed = seed;
  if (options.anneal) options.anneal->seed = seed;
  if (options.descent) options.descent->seed = seed;
}

// The options of `orchard build`, by name; those that are not in the dictionary are standard.
SphereTreeOptions to_options(const py::dict& given, Tuning tuning, bool from_axis, bool within_time) {
  SphereTreeOptions options;
  set_named(given, "redundant", options.redundancy,
            {{"independent", Selection::independent},
             {"acyclic", Selection::acyclic},
             {"exhaustive", Selection::exhaustive}});
  options.tree = to_builder(given, options.redundancy);
  bool anneal = false;
  set(given, "anneal", anneal);
  if (anneal) options.anneal = to_annealing(given, options.redundancy, kCoolStart);
  Index trials = 0;
  set(given, "descent", trials);
  if (trials > 0) options.descent = {.trials_per_node = trials};
  // As the command does: a tightened tree needs no axis, others a raw one; points by need unless they are given.
  const bool samples_given = tuning.contains("samples");
  options.samples_by_need = within_time && !samples_given;
  tuning["refine"] = "no";
  if (!samples_given) tuning["samples"] = std::to_string(samples_needed(options.tree));
  options.medial = to_build_options(tuning);
  set_seed(options, options.medial.sampling.seed);
  options.axis = from_axis;
  require_sizes(options.tree);
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
