#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace orchard::apps {

// Why a command line makes no sense, if it is for a word that is no command or an option that there is not, with the
// one that was probably meant; empty if neither. Before parsing, which would blame something else.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words);

// What the parser has to say about a command line, in one line that names the help.
std::string in_one_line(const CLI::App& app, const CLI::ParseError& error);

}  // namespace orchard::apps
