#include "command_line/list_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "command_line/number_text.h"

namespace orchard::apps {
namespace {

std::string_view without_blanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

// Checks every item. `fault` returns what is wrong with it, or an empty string; `said` describes the values in the
// help.
CLI::Validator each_item(const std::function<std::string(const std::string&)>& fault, const std::string& said) {
  const auto check = [fault](std::string& text) {
    const auto items = list_items(text);
    if (!items) return fmt::format("\"{}\": {}", text, kEmptyItem);
    for (const std::string& item : *items)
      if (std::string what = fault(item); !what.empty()) return what;
    return std::string();
  };
  return {check, said};
}

// One word at a time, so that a list never takes the arguments after it.
CLI::Option* add_words(CLI::App& command, const std::string& option, const std::string& help,
                       const std::function<void(const std::string&)>& take) {
  return command
      .add_option_function<std::vector<std::string>>(
          option,
          [take](const std::vector<std::string>& lists) {
            for (const std::string& list : lists) {
              const auto items = list_items(list);
              for (const std::string& item : *items) take(item);
            }
          },
          help)
      ->allow_extra_args(false);
}

}  // namespace

std::optional<std::vector<std::string>> list_items(std::string_view text) {
  std::vector<std::string> items;
  for (std::size_t begin = 0;;) {
    const std::size_t end = text.find(',', begin);
    items.emplace_back(without_blanks(text.substr(begin, end - begin)));
    if (items.back().empty()) return std::nullopt;
    if (end == std::string_view::npos) return items;
    begin = end + 1;
  }
}

CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<Index>& values, const std::string& help,
                      Index min, Index max) {
  const auto fault = [min, max](const std::string& item) {
    const std::optional<Index> value = whole_number(item);
    const bool within = value && *value >= min && *value <= max;
    return within ? std::string() : fmt::format("{} is not a whole number from {} to {}", item, min, max);
  };
  return add_words(command, option, help, [&values](const std::string& item) { values.push_back(*whole_number(item)); })
      ->type_name("UINT")
      ->check(each_item(fault, max == std::numeric_limits<Index>::max() ? "" : fmt::format("{{{} to {}}}", min, max)));
}

CLI::Option* add_list(CLI::App& command, const std::string& option, std::vector<std::string>& values,
                      const std::string& help, const std::vector<std::string>& choices) {
  const auto fault = [choices](const std::string& item) {
    const bool known = std::find(choices.begin(), choices.end(), item) != choices.end();
    return known ? std::string() : fmt::format("{} is none of {}", item, fmt::join(choices, ", "));
  };
  return add_words(command, option, help, [&values](const std::string& item) { values.push_back(item); })
      ->check(each_item(fault, fmt::format("{{{}}}", fmt::join(choices, ","))));
}

}  // namespace orchard::apps
