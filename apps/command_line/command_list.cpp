#include "command_line/command_list.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "command_line/sweep_option.h"
#include "command_line/text.h"
#include "medial/sweep_columns.h"

namespace orchard::apps {
namespace {

// The words of "{a,b,c}" in the name of a type; none if an item is not a word.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t begin = type.find('{'), end = type.find('}', begin);
  if (begin == std::string::npos || end == std::string::npos) return {};
  std::vector<std::string> choices{""};
  for (const char c : type.substr(begin + 1, end - begin - 1)) {
    if (c == ',') {
      choices.emplace_back();
    } else if (c != ' ' || !choices.back().empty()) {
      choices.back() += c;
    }
  }
  const auto word = [](const std::string& choice) {
    return !choice.empty() && std::isalpha(static_cast<unsigned char>(choice.front())) != 0 &&
           std::all_of(choice.begin(), choice.end(),
                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_'; });
  };
  if (choices.size() < 2 || !std::all_of(choices.begin(), choices.end(), word)) return {};
  return choices;
}

// The range in the name of a type, "{1 to 9}" or "in [1 - 9]", without the brackets.
std::string range_in(const std::string& type) {
  for (const auto& [open, close] : {std::pair{'{', '}'}, {'[', ']'}}) {
    const std::size_t begin = type.find(open), end = type.find(close, begin);
    if (begin == std::string::npos || end == std::string::npos) continue;
    return replaced(type.substr(begin + 1, end - begin - 1), " - ", " to ");
  }
  return {};
}

// Whether the value of an option is a file or folder, which its type does not show.
bool takes_file(const CLI::Option& option) {
  static const std::vector<std::string> named{
      "output", "points", "diagram",      "features",   "from-axis", "axis", "beside", "plot",          "csv",
      "from",   "record", "package-path", "trajectory", "envelope",  "tree", "replay", "vertex-weights"};
  if (option.get_lnames().empty()) return true;
  return std::find(named.begin(), named.end(), option.get_lnames().front()) != named.end();
}

// Values that an option takes beside others, or that its value begins with.
std::vector<std::string> usual_values(const CLI::App& command, const CLI::Option& option) {
  const std::string name = option.get_lnames().empty() ? "" : option.get_lnames().front();
  std::vector<std::string> values;
  if (name == "sweep")
    for (const std::string& swept : sweepable_options(command)) values.push_back(swept + "=");
  if (name == "sort-by")
    for (const Column& column : all_columns({}))
      if (column.rates) values.push_back(column.name);
  if (name == "color") values = {"radius", "structure", "structure_kind", "error", "inaccuracy", "level"};
  return values;
}

// Whether it is a folder: then the help says so, so that the name of the value agrees with it.
bool takes_folder(const CLI::Option& option) {
  return takes_file(option) && option.get_description().starts_with("Folder");
}

std::vector<std::string> option_names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  names.reserve(options.size());
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return names;
}

OptionEntry entry_of(const CLI::App& command, const CLI::Option& option) {
  OptionEntry entry;
  for (const std::string& name : option.get_snames()) entry.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) entry.names.push_back("--" + name);
  entry.positional = entry.names.empty();
  if (entry.positional) entry.names.push_back(option.get_name(true));
  entry.help = option.get_description();
  entry.group = option.get_group();
  entry.needs = option_names(option.get_needs());
  entry.excludes = option_names(option.get_excludes());
  entry.flag = option.get_expected_min() == 0 && !entry.positional;
  entry.required = option.get_required();
  entry.repeats = option.get_expected_max() > 1;
  entry.standard = option.get_default_str();
  entry.file = takes_file(option);
  entry.folder = takes_folder(option);
  if (entry.flag) return entry;
  const std::string type = option.get_type_name();
  entry.choices = choices_in(type);
  if (!entry.choices.empty()) entry.file = false;
  entry.usual = usual_values(command, option);
  entry.value = range_in(type);
  if (entry.value.empty() || !entry.choices.empty()) entry.value = type.substr(0, type.find(':'));
  return entry;
}

CommandEntry entry_of(const CLI::App& command) {
  CommandEntry entry{
      .name = command.get_name(), .help = command.get_description(), .footer = command.get_footer(), .options = {}};
  for (const CLI::Option* option : command.get_options())
    if (!option->get_group().empty()) entry.options.push_back(entry_of(command, *option));
  std::stable_partition(entry.options.begin(), entry.options.end(),
                        [](const OptionEntry& option) { return option.positional; });
  return entry;
}

}  // namespace

bool has_range(const OptionEntry& option) { return option.value.find(" to ") != std::string::npos; }

std::string placeholder_of(const OptionEntry& option) {
  if (option.flag) return {};
  if (!option.choices.empty()) return joined(option.choices, "|");
  if (option.file) return option.folder ? "FOLDER" : "FILE";
  const bool number = option.value == "UINT" || option.value == "INT" || option.value == "FLOAT" || has_range(option);
  return number ? "N" : "VALUE";
}

std::string notes_of(const OptionEntry& option) {
  std::string notes;
  if (has_range(option)) notes += " (" + option.value + ")";
  if (!option.standard.empty()) notes += " [" + option.standard + "]";
  if (!option.needs.empty()) notes += " (needs " + joined(option.needs, ", ") + ")";
  if (!option.excludes.empty()) notes += " (not with " + joined(option.excludes, ", ") + ")";
  return notes;
}

std::string synopsis(const std::string& program, const CommandEntry& command) {
  std::string text = program + " " + command.name;
  for (const OptionEntry& option : command.options) {
    if (option.positional) {
      text += " " + option.names.front() + (option.repeats ? ".." : "");
    } else if (option.required) {
      text += " " + option.names.front() + " " + placeholder_of(option);
    }
  }
  return text + " [options]";
}

std::vector<CommandEntry> command_list(const CLI::App& app) {
  std::vector<CommandEntry> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) commands.push_back(entry_of(*command));
  return commands;
}

}  // namespace orchard::apps
