#include "command_line/sweep_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "command_line/add_commands.h"
#include "command_line/list_option.h"
#include "command_line/text.h"
#include "medial/medial_tuning.h"
#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

// Options that do not change the rows of a sweep, or that a sweep does not accept.
constexpr std::array kNotSwept{"output",   "sweep", "sort-by",        "axis",          "beside",     "export",
                               "threads",  "up",    "envelope",       "envelope-cell", "points",     "diagram",
                               "features", "side",  "outside-radius", "tree-depth",    "importance", "prune-curve"};
// Flags that concern the sweep, not its runs.
constexpr std::array kOfTheSweep{"keep", "report", "picture", "no-views", "quiet", "json", "force"};

template <class Names>
bool among(const std::string& name, const Names& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool is_swept(const std::string& name, const std::vector<SweptOption>& swept) {
  return std::any_of(swept.begin(), swept.end(), [&](const SweptOption& one) { return one.name == name; });
}

// "prune angle" is a measure of --prune; it is given as --prune=angle=VALUE.
const std::string kPruneMeasure = "prune ";

std::string word_of(const std::string& name, const std::string& value) {
  if (!name.starts_with(kPruneMeasure)) return "--" + name + "=" + value;
  return "--prune=" + name.substr(kPruneMeasure.size()) + "=" + value;
}

SweptOption swept_option(const CLI::App& command, const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw InputError("--sweep " + text + ": expected NAME=VALUE,VALUE,..");
  const std::string name = text.substr(0, equals);
  const std::vector<std::string> names = sweepable_options(command);
  if (!among(name, names))
    throw InputError(
        fmt::format("--sweep: no option with values to compare is called {}; there are {}", name, joined(names, ", ")));
  auto values = list_items(text.substr(equals + 1));
  if (!values) throw InputError(fmt::format("--sweep {}: {}", text, kEmptyItem));
  for (const std::string& value : *values)
    if (std::count(values->begin(), values->end(), value) > 1)
      throw InputError(fmt::format("--sweep {}: the value {} is given twice", text, value));
  return {name, std::move(*values)};
}

// Returns the arguments of a command without the swept options and those of the sweep itself.
std::vector<std::string> words_of_runs(const CLI::App& command, const std::vector<SweptOption>& swept) {
  std::vector<std::string> words{command.get_name()};
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::string name = option->get_lnames().empty() ? "" : option->get_lnames().front();
    if (name == "sweep" || name == "sort-by" || among(name, kOfTheSweep) || is_swept(name, swept)) continue;
    if (name == "raw" && is_swept("refine", swept)) continue;  // it is refused where all contradictions are
    const bool flag = option->get_expected_min() == 0;
    for (const std::string& value : option->results()) {
      if (name == "prune" && is_swept(kPruneMeasure + value.substr(0, value.find('=')), swept)) continue;
      if (name.empty())
        words.push_back(value);
      else if (flag && (value == "true" || value == "false"))
        words.push_back("--" + name);
      else
        words.push_back(fmt::format("--{}={}", name, value));
    }
  }
  return words;
}

MedialCommand parsed_run(std::vector<std::string> words, const std::string& combination) {
  CLI::App app{"", "orchard"};
  Request request;
  add_medial(app, request);
  request.typed = "orchard " + joined(words);
  std::reverse(words.begin(), words.end());
  try {
    app.parse(words);
  } catch (const CLI::ParseError& error) {
    throw InputError(fmt::format("--sweep {}: {}", combination, error.what()));
  }
  return std::move(request.medial);
}

// Moves to the next combination; the last option changes fastest. Returns false after the last combination.
bool next_combination(std::vector<std::size_t>& choice, const std::vector<SweptOption>& swept) {
  for (std::size_t d = choice.size(); d-- > 0;) {
    if (++choice[d] < swept[d].values.size()) return true;
    choice[d] = 0;
  }
  return false;
}

}  // namespace

std::vector<std::string> sweepable_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty() || option->get_expected_min() == 0) continue;
    const std::string& name = option->get_lnames().front();
    if (name != "prune" && !among(name, kNotSwept)) names.push_back(name);
  }
  for (const TuningFlag& flag : tuning_flags())
    if (flag.step == TuningStep::pruning) names.push_back(flag.name);
  return names;
}

void expand_sweep(const CLI::App& command, MedialCommand& medial) {
  if (medial.sweep.empty()) return;
  for (const std::string& text : medial.sweep) medial.swept.push_back(swept_option(command, text));
  for (const SweptOption& one : medial.swept)
    if (std::count_if(medial.swept.begin(), medial.swept.end(),
                      [&](const SweptOption& o) { return o.name == one.name; }) > 1)
      throw InputError(fmt::format("--sweep: {} is given twice; give all its values in one --sweep", one.name));
  const std::vector<std::string> typed = words_of_runs(command, medial.swept);
  std::vector<std::size_t> choice(medial.swept.size(), 0);
  do {
    std::vector<std::string> words = typed, values;
    std::string combination;
    for (std::size_t d = 0; d < choice.size(); ++d) {
      const auto& [name, of_option] = medial.swept[d];
      words.push_back(word_of(name, of_option[choice[d]]));
      combination += (d > 0 ? "," : "") + name + "=" + of_option[choice[d]];
      values.push_back(of_option[choice[d]]);
    }
    MedialCommand& run = medial.runs.emplace_back(parsed_run(std::move(words), combination));
    run.choice = std::move(values);
  } while (next_combination(choice, medial.swept));
}

}  // namespace orchard::apps
