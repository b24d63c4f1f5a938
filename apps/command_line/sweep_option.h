#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "command_line/commands.h"

// `--sweep NAME=A,B,..` of `orchard medial`: any option with a value, and the command line of each combination.
namespace orchard::apps {

// The options of a command that a sweep can vary, by their long names, in the order of --help.
std::vector<std::string> sweepable_options(const CLI::App& command);

// Sets medial.swept, and in medial.runs the command of each combination of the values, as if it had been typed. Does
// nothing without a sweep. Precondition: `command` has been parsed into `medial`. Throws InputError, which names the
// combination, for a value that its option does not take.
void expand_sweep(const CLI::App& command, MedialCommand& medial);

}  // namespace orchard::apps
