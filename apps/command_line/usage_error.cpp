#include "command_line/usage_error.h"

#include <algorithm>
#include <string_view>
#include <vector>

namespace orchard::apps {
namespace {

// Returns the number of letters to insert, delete, replace or swap with a neighbour that turns one word into the other.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> table(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t k = 0; k <= b.size(); ++k) {
      std::size_t& cell = table[i][k];
      if (i == 0 || k == 0) {
        cell = i + k;
        continue;
      }
      cell = std::min({table[i - 1][k] + 1, table[i][k - 1] + 1, table[i - 1][k - 1] + (a[i - 1] != b[k - 1])});
      if (i > 1 && k > 1 && a[i - 1] == b[k - 2] && a[i - 2] == b[k - 1])
        cell = std::min(cell, table[i - 2][k - 2] + 1);
    }
  }
  return table[a.size()][b.size()];
}

// Returns ", did you mean X?" if one of the words is similar enough.
std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
  const std::string* best = nullptr;
  // At most a third of the letters, but two in any case.
  std::size_t fewest = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string& candidate : words) {
    const std::size_t count = edits(word, candidate);
    const bool begun = word.size() >= 2 && candidate.starts_with(word);
    if (count < fewest || (begun && best == nullptr)) {
      fewest = std::min(fewest, count);
      best = &candidate;
    }
  }
  return best == nullptr ? std::string() : "; did you mean \"" + *best + "\"?";
}

std::string help_of(const CLI::App& app, const std::string& command) {
  return "\"" + app.get_name() + (command.empty() ? "" : " " + command) + " --help\"";
}

// Returns the first argument from `begin` on that looks like an option and is not one of the command's.
std::string unknown_option(const CLI::App& app, const CLI::App& command, std::size_t begin,
                           const std::vector<std::string>& words) {
  std::vector<std::string> options;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  const std::string name = &app == &command ? std::string() : command.get_name();
  for (std::size_t i = begin; i < words.size() && words[i] != "--"; ++i) {
    const std::string word = words[i].substr(0, words[i].find('='));
    if (!word.starts_with("--") || std::find(options.begin(), options.end(), word) != options.end()) continue;
    std::string message = app.get_name();
    if (!name.empty()) message += " " + name;
    message += " has no option " + word;
    const std::string meant = suggestion(word, options);
    return message += meant.empty() ? "; see " + help_of(app, name) : meant;
  }
  return {};
}

}  // namespace

std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.size() < 2) return {};
  const std::string& command = words[1];
  if (command.starts_with("-")) return unknown_option(app, app, 1, {words[0], words[1]});
  const CLI::App* chosen = nullptr;
  std::vector<std::string> commands;
  for (const CLI::App* one : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands.push_back(one->get_name());
    if (one->get_name() == command) chosen = one;
  }
  if (chosen != nullptr) return unknown_option(app, *chosen, 2, words);
  const std::string meant = suggestion(command, commands);
  return "there is no command \"" + command + "\"" +
         (meant.empty() ? "; " + help_of(app, "") + " lists them all" : meant);
}

std::string in_one_line(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> chosen = app.get_subcommands([](const CLI::App* one) { return one->parsed(); });
  const std::string command = chosen.empty() ? "" : chosen.front()->get_name();
  std::string message = error.what();
  if (chosen.empty() && message == "A subcommand is required") message = "name a command";
  return (command.empty() ? "" : command + ": ") + message + "; see " + help_of(app, command);
}

}  // namespace orchard::apps
