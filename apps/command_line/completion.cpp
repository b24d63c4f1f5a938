#include <fmt/format.h>

#include "command_line/command_list.h"
#include "command_line/text.h"

namespace orchard::apps {
namespace {

// Within single quotes, where zsh's _arguments takes brackets and colons for its own.
std::string zsh_quoted(std::string text) {
  text = replaced(text, "'", "'\\''");
  for (const char* special : {"[", "]", ":"}) text = replaced(text, special, std::string("\\") + special);
  return text;
}

// What may stand for a value: its choices, or else what is usual.
const std::vector<std::string>& completed(const OptionEntry& option) {
  return option.choices.empty() ? option.usual : option.choices;
}

std::string zsh_value(const OptionEntry& option) {
  if (!completed(option).empty()) return "(" + joined(completed(option)) + ")";
  return option.file ? "_files" : " ";
}

std::string zsh_option(const OptionEntry& option) {
  if (option.positional)
    return fmt::format("'{}:{}:{}'", option.repeats ? "*" : "", zsh_quoted(option.names.front()), zsh_value(option));
  const std::string spelled = option.names.size() == 1
                                  ? "'" + std::string(option.repeats ? "*" : "") + option.names.front()
                                  : "'(" + joined(option.names) + ")'{" + joined(option.names, ",") + "}'";
  const std::string value =
      option.flag ? "" : ":" + zsh_quoted(option.value.empty() ? "value" : option.value) + ":" + zsh_value(option);
  return spelled + "[" + zsh_quoted(option.help) + "]" + value + "'";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> commands;
  std::string values, options;
  for (const CommandEntry& command : command_list(app)) {
    commands.push_back(command.name);
    std::vector<std::string> all;
    for (const OptionEntry& option : command.options) {
      if (option.positional) {
        if (!option.choices.empty())
          values += fmt::format("    '{0} {0}') words='{1}' ;;\n", command.name, joined(option.choices));
        continue;
      }
      all.insert(all.end(), option.names.begin(), option.names.end());
      if (option.flag || option.file) continue;
      std::string pattern;
      for (const std::string& name : option.names)
        pattern += (pattern.empty() ? "'" : " | '") + command.name + " " + name + "'";
      values += fmt::format("    {}) words='{}' ;;\n", pattern, joined(completed(option)));
    }
    options += fmt::format("    {}) words='{}' ;;\n", command.name, joined(all));
  }
  return fmt::format(
      "# bash completion for {0}: made by \"{0} completion bash\"\n"
      "_{0}() {{\n"
      "  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words=files\n"
      "  COMPREPLY=()\n"
      "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
      "    mapfile -t COMPREPLY < <(compgen -W '{1}' -- \"$current\")\n"
      "    return\n"
      "  fi\n"
      "  case \"${{COMP_WORDS[1]}} $previous\" in\n"
      "{2}"
      "  esac\n"
      "  if [[ $words == files && $current == -* ]]; then\n"
      "    case ${{COMP_WORDS[1]}} in\n"
      "{3}"
      "    esac\n"
      "  fi\n"
      "  if [ \"$words\" = files ]; then\n"
      "    compopt -o default 2> /dev/null\n"
      "  else\n"
      "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
      "    [[ ${{COMPREPLY[0]-}} != *= ]] || compopt -o nospace 2> /dev/null\n"
      "  fi\n"
      "}}\n"
      "complete -F _{0} {0}\n",
      app.get_name(), joined(commands), values, options);
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, options;
  for (const CommandEntry& command : command_list(app)) {
    commands += fmt::format("    '{}:{}'\n", command.name, zsh_quoted(command.help));
    options += fmt::format("    {})\n      _arguments", command.name);
    for (const OptionEntry& option : command.options) options += " \\\n        " + zsh_option(option);
    options += " ;;\n";
  }
  return fmt::format(
      "#compdef {0}\n"
      "# zsh completion for {0}: made by \"{0} completion zsh\"\n"
      "local -a commands\n"
      "commands=(\n{1}  )\n"
      "if (( CURRENT == 2 )); then\n"
      "  _describe command commands\n"
      "else\n"
      "  local command=$words[2]\n"
      "  shift words\n"
      "  (( CURRENT-- ))\n"
      "  case $command in\n{2}"
      "  esac\n"
      "fi\n",
      app.get_name(), commands, options);
}

}  // namespace orchard::apps
