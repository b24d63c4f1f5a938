#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// All commands and their options as --help says them, for what is made from the same source: shell completion, the
// manual page and the page of all options.
namespace orchard::apps {

struct OptionEntry {
  std::vector<std::string> names;  // "--depth", "-o"; of a word without a name, "mesh"
  std::string help;
  std::string group;                 // the heading of --help that it stands under
  std::string value;                 // what it takes: "" for a flag, "TEXT", "UINT"; its range, if it has one
  std::vector<std::string> choices;  // not empty: one of these
  std::vector<std::string> usual;  // what a shell completes where there are no choices; "samples=" wants more behind it
  std::string standard;            // its value unless it is given; may be empty
  bool flag = false, positional = false, required = false, repeats = false;
  bool file = false;                         // its value is a file or folder
  std::vector<std::string> needs, excludes;  // other options, sorted by name
};

struct CommandEntry {
  std::string name, help, footer;
  std::vector<OptionEntry> options;  // those without a name first
};

// In the order of --help. Commands that --help does not list are left out.
std::vector<CommandEntry> command_list(const CLI::App& app);

// Whether `value` is a range of numbers, "1 to 20".
bool has_range(const OptionEntry& option);

// What stands for an option's value in its usage: its choices, FILE, N or VALUE; empty for a flag.
std::string placeholder_of(const OptionEntry& option);

// What is to be said after an option's help: its range, its default, the options that it needs or excludes. It begins
// with a blank unless it is empty.
std::string notes_of(const OptionEntry& option);

// "orchard build mesh -o FILE [options]".
std::string synopsis(const std::string& program, const CommandEntry& command);

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string markdown_reference(const CLI::App& app);
std::string manual_page(const CLI::App& app, const std::string& version);

}  // namespace orchard::apps
