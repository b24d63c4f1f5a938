#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace orchard::apps {

// Prints --help of the program and of its commands: usage, options by groups, examples. Lines fit 100 columns.
class HelpFormatter : public CLI::FormatterBase {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

// Puts the options of all commands into the groups Input, Output, Quality and Expert. Options that have a group of
// their own keep it; the others stay in the group Options.
void group_options(CLI::App& app);

}  // namespace orchard::apps
