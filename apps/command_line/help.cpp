#include "command_line/help.h"

#include <algorithm>
#include <sstream>
#include <string_view>

#include "command_line/command_list.h"
#include "command_line/text.h"

namespace orchard::apps {
namespace {

constexpr std::size_t kWidth = 100;  // columns that a line may have
constexpr std::size_t kHelpColumn = 26;

// The words of `text`, broken into lines that end before kWidth, each but the first after `indent` blanks.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::istringstream words(text);
  std::string result;
  std::size_t column = indent;
  for (std::string word; words >> word;) {
    const bool first = column == indent;
    if (!first && column + 1 + word.size() > kWidth) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (!first) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

std::string row_of(const OptionEntry& option) {
  std::string left = "  " + joined(option.names, ", ");
  const std::string value = placeholder_of(option);
  if (!option.positional && !value.empty()) left += " " + value;
  const std::string help = wrapped(option.help + "." + notes_of(option), kHelpColumn);
  const bool fits = left.size() + 2 <= kHelpColumn;
  return left + (fits ? std::string(kHelpColumn - left.size(), ' ') : "\n" + std::string(kHelpColumn, ' ')) + help +
         "\n";
}

std::string help_of(const std::string& program, const CommandEntry& command) {
  std::string text = command.help + ".\n\nUsage:\n  " + synopsis(program, command) + "\n";
  const auto group_of = [](const OptionEntry& option) { return option.positional ? "Arguments" : option.group; };
  std::vector<std::string> groups{"Arguments", "Input", "Quality", "Output"};
  const std::vector<std::string> last{"Expert", "Options"};
  for (const OptionEntry& option : command.options) {
    const auto has = [&](const std::vector<std::string>& names) {
      return std::find(names.begin(), names.end(), group_of(option)) != names.end();
    };
    if (!has(groups) && !has(last)) groups.push_back(group_of(option));
  }
  groups.insert(groups.end(), last.begin(), last.end());
  for (const std::string& group : groups) {
    std::string rows;
    for (const OptionEntry& option : command.options)
      if (group_of(option) == group) rows += row_of(option);
    if (!rows.empty()) text += fmt::format("\n{}:\n{}", group, rows);
  }
  return command.footer.empty() ? text : text + "\n" + command.footer + "\n";
}

std::string help_of(const CLI::App& app) {
  std::string text =
      wrapped(app.get_description() + ".", 0) + "\n\nUsage:\n  " + app.get_name() + " COMMAND [options]\n\nCommands:\n";
  for (const CommandEntry& command : command_list(app)) {
    const std::string name = "  " + command.name;
    text += name + std::string(16 - name.size(), ' ') + wrapped(command.help, 16) + "\n";
  }
  text += "\nOptions:\n  -h, --help    Print this help\n  --version     Print the version\n";
  return text + "\n" + app.get_footer() + "\n";
}

struct Group {
  const char* name;
  std::vector<std::string_view> options;  // "tree" in all commands, "simulate tree" in one of them
};

const std::vector<Group>& groups() {
  static const std::vector<Group> table{
      {"Input",
       {"strict",         "wrap",         "wrap-alpha",  "noise",  "fill-holes",   "join",          "union",
        "points",         "diagram",      "from-axis",   "axis",   "features",     "side",          "outside-radius",
        "spheres clip",   "buffer",       "bbox-center", "pose",   "pose-a",       "simulate tree", "replay",
        "vertex-weights", "full",         "box",         "format", "scale",        "unit",          "audit link",
        "weight",         "package-path", "no-wrap",     "visual", "ignore-units", "ignore-up",     "from"}},
      {"Output", {"output",       "views",  "no-views",     "picture",       "export",      "export-level",
                  "report",       "up",     "json",         "quiet",         "force",       "accept",
                  "plot",         "csv",    "envelope",     "envelope-cell", "error-curve", "spheres tree",
                  "spheres link", "record", "cells",        "cost",          "bins",        "beside",
                  "tool-frame",   "joints", "acceleration", "jerk",          "resolution",  "robot density",
                  "trajectory",   "trees",  "no-picture",   "window",        "light",       "meshes"}},
      {"Quality",
       {"method",       "depth",         "branching",   "spheres",      "effort",     "objective", "error",
        "region",       "time",          "fit",         "volume-error", "solid",      "padding",   "min-radius",
        "samples",      "edge-samples",  "vertices",    "medial balls", "definition", "facing",    "below",
        "fail-below",   "distance",      "hollow",      "tolerance",    "refine",     "raw",       "border-loss",
        "linear-error", "feature-loss",  "edge-length", "prune",        "by",         "neck",      "min-area",
        "triangles",    "skeleton-edge", "algorithm",   "flights",      "bodies",     "frames",    "budget",
        "robot link",   "fit-link",      "states",      "anneal",       "builders"}},
      {"Particles (for --fit particles)",
       {"overlap", "equal", "spheres density", "density-of", "masses", "center-error", "inertia-error"}},
      {"Picture",
       {"level", "camera", "view up", "size", "opacity", "color", "range", "look-at", "width", "view clip",
        "view balls", "edges", "layout", "captions", "transparent", "turn"}},
      {"Running", {"shard", "jobs", "timeout", "memory", "resume"}},
      {"Expert", {"seed",          "threads",      "root-ball",    "smooth",        "quality-samples", "sweep",
                  "sort-by",       "straighten",   "seam-rounds",  "medial tree",   "tree-depth",      "connect",
                  "closing",       "energy",       "redundant",    "descent",       "relaxation",      "iterations",
                  "cluster-angle", "crease-angle", "gaps",         "joined-radius", "max-passes",      "thin",
                  "coalesce",      "topology",     "reach-rounds", "open-rounds",   "segment-angle",   "compare"}}};
  return table;
}

}  // namespace

std::string HelpFormatter::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  const CLI::App* parent = app->get_parent();
  if (parent == nullptr || mode != CLI::AppFormatMode::Normal) return help_of(*app);
  for (const CommandEntry& command : command_list(*parent))
    if (command.name == app->get_name()) return help_of(parent->get_name(), command);
  return app->get_description() + "\n\nUsage:\n  " + name + "\n";  // a command that the list leaves out
}

void group_options(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_lnames().empty() || option->get_group() != "Options") continue;
      const std::string name = option->get_lnames().front(), here = command->get_name() + " " + name;
      for (const Group& group : groups())
        for (const std::string_view one : group.options)
          if (one == name || one == here) option->group(group.name);
    }
  }
}

}  // namespace orchard::apps
