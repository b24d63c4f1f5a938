#pragma once
#include <CLI/CLI.hpp>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orchard/geometry/mesh.h"

// Options whose value is a list, "8,64,512", all parsed alike: each item must be there and be one, or the command line
// is refused before anything is done. (The parser's own lists drop empty items.)
namespace orchard::apps {

// The items of "a,b,c" without the blanks around them; nothing where one is empty.
std::optional<std::vector<std::string>> list_items(std::string_view text);

// What is wrong with a list that has no items so.
inline constexpr const char* kEmptyItem = "an item of the list is empty: give values with single commas between them";

// An option of whole numbers from `min` to `max`; given again, its numbers come behind the others.
CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<Index>& values, const std::string& help,
                      Index min = 0, Index max = std::numeric_limits<Index>::max());

// An option of some of the words of `choices`; likewise.
CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& values,
                      const std::string& help, const std::vector<std::string>& choices);

}  // namespace orchard::apps
