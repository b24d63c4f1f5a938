#pragma once
#include <CLI/CLI.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh.h"

// Options whose value is a list, "8,64,512". Each item must be present and valid, or the command line is refused before
// any work. (The parser's own lists would drop empty items.)
namespace orchard::apps {

// Returns the items of "a,b,c" without surrounding blanks; nullopt if one is empty.
std::optional<std::vector<std::string>> list_items(std::string_view text);

// The message for such a list.
inline constexpr const char* kEmptyItem = "an item of the list is empty: give values with single commas between them";

// Adds an option of whole numbers from `min` to `max`. If it is given several times, the numbers are appended.
CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<Index>& values, const std::string& help,
                      Index min = 0, Index max = std::numeric_limits<Index>::max());

// The same for an option whose items are words of `choices`.
CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& values,
                      const std::string& help, const std::vector<std::string>& choices);

}  // namespace orchard::apps
