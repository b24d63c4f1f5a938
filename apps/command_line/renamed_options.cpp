#include "command_line/renamed_options.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "orchard/geometry/error.h"

namespace orchard::apps {
namespace {

struct Renamed {
  std::string_view command, was, is;
};
constexpr std::array kRenamed{Renamed{"verify", "--bbox-centre", "--bbox-center"},
                              Renamed{"medial", "--best", "--sort-by"}};

struct Removed {
  std::string_view command, was, instead;
};
constexpr std::array kRemoved{
    Removed{"medial", "--sharp-angle",
            "give --feature-loss, the percentage of the diagonal that an edge must be worth for sheets to reach it"}};

}  // namespace

std::vector<std::string> rename_options(std::vector<std::string>& words) {
  std::vector<std::string> warnings;
  if (words.size() < 2) return warnings;
  for (std::size_t i = 2; i < words.size() && words[i] != "--"; ++i) {
    const std::size_t end = words[i].find('=');
    const std::string name = words[i].substr(0, end);
    for (const Removed& option : kRemoved)
      if (words[1] == option.command && name == option.was)
        throw InputError(fmt::format("{} has no option {} any more; {}", words[1], name, option.instead));
    for (const Renamed& option : kRenamed) {
      if (words[1] != option.command || name != option.was) continue;
      warnings.push_back(
          fmt::format("{} is called {} now; the old name will be gone in the next version", name, option.is));
      words[i] = std::string(option.is) + (end == std::string::npos ? "" : words[i].substr(end));
    }
  }
  return warnings;
}

}  // namespace orchard::apps
