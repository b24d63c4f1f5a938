#include "idle_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "orchard/geometry/error.h"
#include "tree_options.h"

namespace orchard::apps {
namespace {

// What options of tree_options.cpp are for, where that is not every method.
struct OwnOption {
  const char* option;
  std::vector<TreeMethod> methods;
};
const std::vector<OwnOption>& own_options() {
  static const std::vector<OwnOption> options{{"effort", {TreeMethod::tightened, TreeMethod::annealing}},
                                              {"objective", {TreeMethod::tightened}},
                                              {"closing", {TreeMethod::merging}},
                                              {"energy", {TreeMethod::annealing}}};
  return options;
}

std::string names_of(const std::vector<TreeMethod>& methods) {
  std::vector<std::string> names;
  names.reserve(methods.size());
  for (const TreeMethod method : methods) names.emplace_back(name(method));
  return fmt::format("{}", fmt::join(names, " and "));
}

// The steps to an axis that a file stands in for. An axis of one's own still gets points on the surface, and is pruned.
std::vector<TuningStep> steps_replaced(const std::string& source) {
  if (source == "points") return {TuningStep::points};
  if (source == "diagram") return {TuningStep::points, TuningStep::diagram};
  return {TuningStep::diagram, TuningStep::axis};
}

}  // namespace

void refuse_idle_options(const BuildCommand& command) {
  const auto given = [&](const std::string& option) {
    return std::find(command.given.begin(), command.given.end(), option) != command.given.end();
  };
  const TreeMethod method = command.options.method;
  for (const auto& [option, methods] : own_options()) {
    if (given(option) && std::find(methods.begin(), methods.end(), method) == methods.end())
      throw InputError(
          fmt::format("--{} has no effect on --method {}; it is for {}", option, name(method), names_of(methods)));
  }
  std::vector<std::string> sources;
  for (const char* source : {"points", "diagram", "from-axis"})
    if (given(source)) sources.emplace_back(source);
  const auto refuse_without_axis = [&](const std::string& option) {
    throw InputError(fmt::format("--{} has no effect on --method {}, which builds from no medial axis; it is for {}",
                                 option, name(method), names_of({TreeMethod::tightened, TreeMethod::merging})));
  };
  if (!needs_axis(method) && !sources.empty()) refuse_without_axis(sources.front());
  for (const TuningFlag& flag : tuning_flags()) {
    if (!given(flag.name) || flag.name == "seed") continue;
    if (!needs_axis(method)) refuse_without_axis(flag.name);
    for (const std::string& source : sources) {
      const std::vector<TuningStep> replaced = steps_replaced(source);
      if (std::find(replaced.begin(), replaced.end(), flag.step) != replaced.end())
        throw InputError(
            fmt::format("--{} has no effect with --{}, whose file is in place of that step", flag.name, source));
    }
  }
}

}  // namespace orchard::apps
