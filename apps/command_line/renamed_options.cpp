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
                              Renamed{"medial", "--best", "--sort-by"}, Renamed{"medial", "--curve", "--error-curve"},
                              Renamed{"spheres", "--curve", "--error-curve"}};

// Options that became measures of another one: --prune-angle 20 is --prune angle=20, and in --sweep 'prune angle=..'.
struct Merged {
  std::string_view was, option, measure;
};
constexpr std::array kMerged{Merged{"--prune-angle", "--prune", "angle"}, Merged{"--prune-scale", "--prune", "scale"}};

// Measures by which a sweep may be sorted.
struct RenamedMeasure {
  std::string_view was, is;
};
constexpr std::array kRenamedMeasures{RenamedMeasure{"sheets", "face_components"},
                                      RenamedMeasure{"wires", "curve_components"},
                                      RenamedMeasure{"sheets_between_seams", "sheet_count"}};

struct Removed {
  std::string_view command, was, instead;
};
constexpr std::array kRemoved{
    Removed{"medial", "--sharp-angle",
            "give --feature-loss, the percentage of the diagonal that an edge must be worth for sheets to reach it"}};

std::string renamed_warning(const std::string& was, const std::string& is) {
  return fmt::format("{} is called {} now; the old name will be gone in the next version", was, is);
}

// Replaces a merged option at `at`, whose value is the next word or behind "=".
void rename_merged(std::vector<std::string>& words, std::size_t at, std::vector<std::string>& warnings) {
  const std::size_t end = words[at].find('=');
  const std::string name = words[at].substr(0, end);
  for (const Merged& option : kMerged) {
    if (name != option.was) continue;
    warnings.push_back(renamed_warning(name, fmt::format("{} {}=VALUE", option.option, option.measure)));
    if (end == std::string::npos && at + 1 == words.size()) continue;  // without a value, which the parser refuses
    const std::string value = end == std::string::npos ? words[at + 1] : words[at].substr(end + 1);
    words[at] = option.option;
    if (end == std::string::npos) {
      words[at + 1] = fmt::format("{}={}", option.measure, value);
    } else {
      words[at] += fmt::format("={}={}", option.measure, value);
    }
  }
}

// The same in the value of --sweep, where a former name of --prune-angle was "prune".
void rename_swept(std::vector<std::string>& words, std::size_t at, std::vector<std::string>& warnings) {
  constexpr std::string_view kSweep = "--sweep";
  const bool inside = words[at].rfind("--sweep=", 0) == 0;
  if (!inside && (words[at] != kSweep || at + 1 == words.size())) return;
  std::string& word = words[inside ? at : at + 1];
  const std::size_t begin = inside ? kSweep.size() + 1 : 0, end = word.find('=', begin);
  if (end == std::string::npos) return;
  const std::string name = word.substr(begin, end - begin);
  for (const Merged& option : kMerged) {
    const bool is_alias = name == "prune" && option.measure == "angle";
    if (name != option.was.substr(2) && !is_alias) continue;
    const std::string is = fmt::format("{} {}", option.option.substr(2), option.measure);
    warnings.push_back(renamed_warning("--sweep " + name + "=", fmt::format("--sweep '{}='", is)));
    word.replace(begin, end - begin, is);
    return;
  }
}

// The same of a measure, the value of --sort-by.
void rename_sorted(std::vector<std::string>& words, std::size_t at, std::vector<std::string>& warnings) {
  constexpr std::string_view kSortBy = "--sort-by";
  const bool inside = words[at].rfind("--sort-by=", 0) == 0;
  if (!inside && (words[at] != kSortBy || at + 1 == words.size())) return;
  std::string& word = words[inside ? at : at + 1];
  const std::size_t begin = inside ? kSortBy.size() + 1 : 0;
  for (const RenamedMeasure& measure : kRenamedMeasures) {
    if (word.substr(begin) != measure.was) continue;
    warnings.push_back(
        renamed_warning(fmt::format("{} {}", kSortBy, measure.was), fmt::format("{} {}", kSortBy, measure.is)));
    word = word.substr(0, begin) + std::string(measure.is);
    return;
  }
}

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
      warnings.push_back(renamed_warning(name, std::string(option.is)));
      words[i] = std::string(option.is) + (end == std::string::npos ? "" : words[i].substr(end));
    }
    if (words[1] == "medial" || words[1] == "build") {
      rename_merged(words, i, warnings);
      rename_swept(words, i, warnings);
      rename_sorted(words, i, warnings);
    }
  }
  return warnings;
}

}  // namespace orchard::apps
