#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace orchard::apps {

// If an argument is an unknown command or option, returns an error that names it and the one that was probably meant;
// otherwise an empty string. Call it before parsing, because the parser would report something else.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words);

// Returns the parser's error about a command line as one line that names the help.
std::string in_one_line(const CLI::App& app, const CLI::ParseError& error);

}  // namespace orchard::apps
