#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// All commands and their options as --help lists them. Shell completion, the manual page and the page of all options
// are made from this list, too.
namespace orchard::apps {

struct OptionEntry {
  std::vector<std::string> names;  // "--depth", "-o"; "mesh" for an argument without a name
  std::string help;
  std::string group;                 // its heading in --help
  std::string value;                 // the range of its value, or else the type, "TEXT" or "UINT"; "" for a flag
  std::vector<std::string> choices;  // the words that it accepts; empty if it accepts others
  std::vector<std::string> usual;    // what a shell completes without choices; "samples=" is followed by a value
  std::string standard;              // its default value; may be empty
  bool flag = false, positional = false, required = false, repeats = false;
  bool file = false, folder = false;         // its value is a file or folder; it is a folder
  std::vector<std::string> needs, excludes;  // other options, sorted by name
};

struct CommandEntry {
  std::string name, help, footer;
  std::vector<OptionEntry> options;  // arguments without a name come first
};

// Returns the commands in the order of --help, without those that --help does not list.
std::vector<CommandEntry> command_list(const CLI::App& app);

// Whether `value` is a range of numbers, "1 to 20".
bool has_range(const OptionEntry& option);

// The name of an option's value in --help: its choices, FILE, FOLDER, N or VALUE; empty for a flag.
std::string placeholder_of(const OptionEntry& option);

// The notes after an option's help: its range, its default, the options that it needs or excludes. The text begins with
// a blank unless it is empty.
std::string notes_of(const OptionEntry& option);

// "orchard build mesh -o FOLDER [options]".
std::string synopsis(const std::string& program, const CommandEntry& command);

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string markdown_reference(const CLI::App& app);
std::string manual_page(const CLI::App& app, const std::string& version);

}  // namespace orchard::apps
