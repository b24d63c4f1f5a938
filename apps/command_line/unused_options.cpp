#include "command_line/unused_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "command_line/text.h"
#include "command_line/tree_options.h"
#include "medial/medial_run.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

// The methods that options of tree_options.cpp belong to, for options that do not belong to all.
struct OwnOption {
  const char* option;
  std::vector<TreeMethod> methods;
};
const std::vector<OwnOption>& own_options() {
  static const std::vector<OwnOption> options = [] {
    std::vector<OwnOption> own{{"effort", {TreeMethod::tightened, TreeMethod::annealing}},
                               {"objective", {TreeMethod::tightened}},
                               {"spheres", {TreeMethod::tightened}},
                               {"time", {TreeMethod::tightened}},
                               {"closing", {TreeMethod::merging}}};
    for (const char* option :
         {"energy", "anneal-distance", "anneal-move", "anneal-min-scale", "anneal-max-scale", "anneal-first-trials",
          "anneal-first-acceptance", "anneal-max-accepted", "anneal-max-rejected", "anneal-max-uncovering",
          "anneal-cooling", "anneal-first-iterations", "anneal-iterations"})
      own.push_back({option, {TreeMethod::annealing}});
    return own;
  }();
  return options;
}

std::string method_names(const std::vector<TreeMethod>& methods) {
  std::vector<std::string> names;
  names.reserve(methods.size());
  for (const TreeMethod method : methods) names.emplace_back(name(method));
  return fmt::format("{}", fmt::join(names, " and "));
}

// Returns the steps that a file replaces. An axis of the user's still gets surface points, and is pruned.
std::vector<TuningStep> steps_replaced(const std::string& source) {
  if (source == "points") return {TuningStep::points, TuningStep::open_places};
  if (source == "diagram") return {TuningStep::points, TuningStep::diagram, TuningStep::open_places};
  return {TuningStep::diagram, TuningStep::axis};
}

using FlagNames = std::vector<std::string>;

// Refuses flags for a step that a file replaces.
void refuse_replaced(const TuningFlag& flag, const FlagNames& sources) {
  for (const std::string& source : sources) {
    const std::vector<TuningStep> replaced = steps_replaced(source);
    if (std::find(replaced.begin(), replaced.end(), flag.step) != replaced.end())
      throw InputError(fmt::format("--{} has no effect with --{}, whose file replaces that step", flag.name, source));
  }
}

// Refuses a flag that has no effect because of the values of other flags, in all of the tunings that are run.
void refuse_disabled(const TuningFlag& flag, const std::vector<MedialTuning>& tunings) {
  if (!flag.unused) return;
  std::string why;
  for (const MedialTuning& tuning : tunings) {
    why = flag.unused(tuning);
    if (why.empty()) return;
  }
  throw InputError(fmt::format("--{} has no effect with {}", flag.name, why));
}

// Refuses options that a sweep overrides, and options that it varies without a column that shows the effect.
void refuse_unused_in_sweep(const MedialCommand& command, const FlagNames& swept) {
  for (const std::string& name : swept) {
    if (among(name, command.given))
      throw InputError(fmt::format("--{} has no effect with --sweep {}=.., which sets it", name, name));
  }
  if (among("raw", command.given) && among("refine", swept))
    throw InputError("--raw has no effect with --sweep refine=.., which sets it");
}

}  // namespace

void refuse_unused_options(const BuildCommand& command) {
  const TreeMethod method = command.tree.method;
  if (command.tree.anneal && method == TreeMethod::annealing)
    throw InputError("--anneal has no effect on --method annealing, which anneals anyway; leave it out");
  for (const auto& [option, methods] : own_options()) {
    const auto is_for = [&, &own = methods](TreeMethod m) { return std::find(own.begin(), own.end(), m) != own.end(); };
    const bool anneals = is_for(TreeMethod::annealing);
    if (!among(option, command.given) || is_for(method) || (anneals && command.tree.anneal)) continue;
    throw InputError(fmt::format("--{} has no effect on --method {}; it is for {}{}", option, name(method),
                                 method_names(methods), anneals ? ", and for others with --anneal" : ""));
  }
  FlagNames sources;
  for (const char* source : {"points", "diagram", "from-axis"})
    if (among(source, command.given)) sources.emplace_back(source);
  const auto refuse_without_axis = [&](const std::string& option) {
    throw InputError(fmt::format("--{} has no effect on --method {}, which builds from no medial axis; it is for {}",
                                 option, name(method), method_names({TreeMethod::tightened, TreeMethod::merging})));
  };
  if (!samples_surface(method) && !sources.empty()) refuse_without_axis(sources.front());
  for (const TuningFlag& flag : tuning_flags()) {
    if (!among(flag.name, command.given) || flag.name == "seed") continue;
    if (!samples_surface(method)) refuse_without_axis(flag.name);
    refuse_replaced(flag, sources);
    refuse_disabled(flag, {command.tuning});
  }
}

void refuse_unused_options(const MedialCommand& command) {
  const bool judges = !command.axis.empty(), sweeps = !command.sweep.empty();
  if (among("quality-samples", command.given) && !command.report && !judges && !sweeps && command.prune_curve.empty())
    throw InputError(
        "--quality-samples has no effect without --report, --prune-curve, --axis or --sweep, because nothing is "
        "measured");
  if (!command.beside.empty() && (sweeps || (!command.report && !judges)))
    throw InputError("--beside needs --report or --axis, whose table shows the other axes");
  if (!command.exports.empty() && sweeps && !command.keep)
    throw InputError("--export has no effect with --sweep, which writes no axis without --keep");
  if (command.keep && !sweeps) throw InputError("--keep has no effect without --sweep, because all files are kept");
  if (among("sort-by", command.given) && !sweeps) throw InputError("--sort-by has no effect without --sweep");
  if (among("light", command.given) && (sweeps || judges || !command.views))
    throw InputError(
        fmt::format("--light has no effect with {}, which writes no views of the axis", sweeps   ? "--sweep"
                                                                                        : judges ? "--axis"
                                                                                                 : "--no-views"));
  if (command.picture && (sweeps || (!command.report && !judges)))
    throw InputError("--picture needs --report or --axis, because it shows where their measures are worst");
  const FlagNames swept = swept_flags(command);
  refuse_unused_in_sweep(command, swept);
  if (judges && among("raw", command.given)) throw InputError("--raw has no effect with --axis, which builds nothing");
  if (!command.features.empty()) {
    if (judges || sweeps || command.outside || !command.tuning.refine)
      throw InputError(fmt::format("--features has no effect with {}", judges   ? "--axis, which builds nothing"
                                                                       : sweeps ? "--sweep"
                                                                       : command.outside ? "--side outside"
                                                                                         : "--raw or --refine no"));
    if (among("feature-loss", command.given))
      throw InputError("--feature-loss has no effect with --features, which says where sheets end");
  }
  FlagNames sources;
  for (const char* source : {"points", "diagram"})
    if (among(source, command.given)) sources.emplace_back(source);
  const std::vector<MedialTuning> tunings = tunings_of(command);
  for (const TuningFlag& flag : tuning_flags()) {
    if ((!among(flag.name, command.given) && !among(flag.name, swept)) || flag.name == "seed") continue;
    if (judges) throw InputError(fmt::format("--{} has no effect with --axis, which builds nothing", flag.name));
    if (sweeps && flag.step == TuningStep::report)
      throw InputError(fmt::format("--{} has no effect with --sweep, whose table does not depend on it", flag.name));
    refuse_replaced(flag, sources);
    refuse_disabled(flag, tunings);
  }
}

}  // namespace orchard::apps
