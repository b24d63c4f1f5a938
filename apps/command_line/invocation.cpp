#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "command_line/text.h"
#include "output/provenance.h"

namespace orchard::apps {
namespace {

using nlohmann::json;

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Whether an option says only where files go and what is printed, not what files contain.
bool decides_nothing(const std::string& name) {
  static constexpr std::array<std::string_view, 6> kNames{"help", "output", "threads", "quiet", "json", "force"};
  return is_one_of(kNames, name);
}

bool names_files(const CLI::App& command, const CLI::Option& option) {
  static constexpr std::array<std::string_view, 15> kNames{
      "points",   "diagram", "features", "from-axis", "axis",       "beside",       "plot",          "csv",
      "envelope", "record",  "replay",   "from",      "trajectory", "package-path", "vertex-weights"};
  if (option.get_lnames().empty()) return option.get_name(true) != "scene";
  const std::string& name = option.get_lnames().front();
  return is_one_of(kNames, name) || (name == "tree" && command.get_name() == "simulate");  // elsewhere it is a method
}

// Quotes a word so that a shell reads it as one word.
std::string word(const std::string& text) {
  const bool plain = std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_-+=.,:/%@").find(static_cast<char>(c)) != std::string_view::npos;
  });
  return plain && !text.empty() ? text : "'" + replaced(text, "'", "'\\''") + "'";
}

std::vector<std::string> values_of(const CLI::App& command, const CLI::Option& option) {
  std::vector<std::string> values = option.results();
  if (names_files(command, option))
    for (std::string& value : values) value = std::filesystem::path(value).filename().string();
  return values;
}

// "--depth 2", "--beside a.ma --beside b.ma", "--box 0 0 0 1 1 1", "--no-views", "--wrap=0.01".
std::vector<std::string> words_of(const CLI::Option& option, const std::vector<std::string>& values) {
  const std::string name = "--" + option.get_lnames().front();
  if (option.get_expected_min() == 0) {
    const bool plain = values.empty() || values.front() == "true" || values.front() == "false";
    return {plain ? name : name + "=" + values.front()};
  }
  std::vector<std::string> words;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || option.get_expected_min() == 1) words.push_back(name);
    words.push_back(word(values[i]));
  }
  return words;
}

json value_of(const CLI::Option& option, const std::vector<std::string>& values) {
  if (option.get_expected_min() == 0 && (values.empty() || values.front() == "true" || values.front() == "false"))
    return true;
  return values.size() == 1 ? json(values.front()) : json(values);
}

std::optional<std::uint64_t> seed_of(const CLI::App& command) {
  const CLI::Option* const option = command.get_option_no_throw("--seed");
  if (option == nullptr) return std::nullopt;
  const std::string text = option->count() > 0 ? option->results().back() : "1";
  return text.find_first_not_of("0123456789") == std::string::npos ? std::optional(std::stoull(text)) : std::nullopt;
}

}  // namespace

Invocation invocation_of(const CLI::App& command, const std::string& typed) {
  Invocation run{.typed = typed, .command_line = {}, .seed = seed_of(command)};
  std::vector<std::string> words{"orchard", command.get_name()}, options;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0) continue;
    const std::vector<std::string> values = values_of(command, *option);
    if (option->get_lnames().empty()) {
      for (const std::string& value : values) words.push_back(word(value));
      continue;
    }
    const std::string& name = option->get_lnames().front();
    if (decides_nothing(name)) continue;
    for (const std::string& one : words_of(*option, values)) options.push_back(one);
    run.options[name] = value_of(*option, values);
  }
  words.insert(words.end(), options.begin(), options.end());
  run.command_line = joined(words);
  return run;
}

}  // namespace orchard::apps
