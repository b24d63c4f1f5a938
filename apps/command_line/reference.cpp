#include <fmt/format.h>

#include "command_line/command_list.h"
#include "command_line/exit_code.h"
#include "command_line/text.h"

namespace orchard::apps {
namespace {

std::string markdown_cell(const std::string& text) { return replaced(replaced(text, "|", "\\|"), "<", "&lt;"); }

// The lines of a footer that are commands.
std::vector<std::string> examples(const CommandEntry& command) {
  std::vector<std::string> lines;
  std::string rest = command.footer + "\n";
  for (std::size_t end = 0; (end = rest.find('\n')) != std::string::npos; rest.erase(0, end + 1))
    if (rest.starts_with("  ")) lines.push_back(rest.substr(2, end - 2));
  return lines;
}

std::string exit_code_table() {
  std::string text = "\n## Exit codes\n\n| Code | Meaning |\n|---:|---|\n";
  for (const ExitCodeRow& row : exit_codes())
    text += fmt::format("| {} | {} |\n", int{row.code}, markdown_cell(row.meaning));
  return text;
}

std::string roff(const std::string& text) {
  std::string result = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (result.starts_with(".") || result.starts_with("'")) result = "\\&" + result;
  return result;
}

}  // namespace

std::string markdown_reference(const CLI::App& app) {
  std::string text =
      "# All commands and options\n\nMade by `orchard reference markdown`, from what `orchard COMMAND --help` says; a "
      "test "
      "compares the two.\n" +
      exit_code_table();
  for (const CommandEntry& command : command_list(app)) {
    text += fmt::format("\n## {0} {1}\n\n{2}.\n\n```text\n{3}\n```\n\n| Option | Value | |\n|---|---|---|\n",
                        app.get_name(), command.name, command.help, synopsis(app.get_name(), command));
    for (const OptionEntry& option : command.options) {
      const std::string value = placeholder_of(option);
      text += fmt::format("| `{}` | {} | {} |\n", joined(option.names, "`, `"),
                          value.empty() ? "" : "`" + markdown_cell(value) + "`",
                          markdown_cell(option.help + "." + notes_of(option)));
    }
    const std::vector<std::string> lines = examples(command);
    if (!lines.empty()) text += "\n```sh\n" + joined(lines, "\n") + "\n```\n";
  }
  return text;
}

std::string manual_page(const CLI::App& app, const std::string& version) {
  const std::string& name = app.get_name();
  std::string text = fmt::format(
      ".TH ORCHARD 1 \"\" \"{0} {1}\" \"User Commands\"\n.SH NAME\n{0} \\- sphere\\-trees, medial axes and collision "
      "answers from triangle meshes\n.SH SYNOPSIS\n.B {0}\n.I COMMAND\n[options]\n.SH DESCRIPTION\n{2}.\n",
      name, version, roff(app.get_description()));
  for (const CommandEntry& command : command_list(app)) {
    text += fmt::format(".SH {} {}\n{}.\n.PP\n.B {}\n", name, command.name, roff(command.help),
                        roff(synopsis(name, command)));
    for (const OptionEntry& option : command.options) {
      const std::string value = placeholder_of(option);
      text += fmt::format(".TP\n.B {}{}\n{}\n", roff(joined(option.names, ", ")),
                          value.empty() ? "" : " \\fR" + roff(value), roff(option.help + "." + notes_of(option)));
    }
    for (const std::string& line : examples(command)) text += ".PP\n.RS\n.B " + roff(line) + "\n.RE\n";
  }
  text += ".SH EXIT STATUS\n";
  for (const ExitCodeRow& row : exit_codes())
    text += fmt::format(".TP\n.B {}\n{}.\n", int{row.code}, roff(row.meaning));
  return text + ".SH FILES\nThe formats are described in reference/formats.md of the documentation.\n";
}

}  // namespace orchard::apps
