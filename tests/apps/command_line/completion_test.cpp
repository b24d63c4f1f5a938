#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "program.h"

// What a shell completes is what --help says.
namespace orchard {
namespace {

using test::Finished;
using test::Workplace;

// What bash offers after these words, the last of which is being typed.
std::set<std::string> offered(const Workplace& here, const std::string& script, const std::string& words) {
  const std::string out = (here / "offered").string();
  const std::string command =
      "bash -c '. " + script + "; COMP_WORDS=(" + words +
      "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _orchard; printf \"%s\\n\" \"${COMPREPLY[@]}\"' > " + out;
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::ifstream stream(out);
  std::set<std::string> result;
  for (std::string line; std::getline(stream, line);) result.insert(line);
  return result;
}

TEST(Completion, OffersBashWhatTheHelpSays) {
  const Workplace here;
  const Finished run = here.run({"completion", "bash"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string script = here.add("script.sh", run.out);
  using Words = std::set<std::string>;
  EXPECT_EQ(offered(here, script, "orchard co"), (Words{"collide", "compare", "completion"}));
  EXPECT_EQ(offered(here, script, "orchard build --method a"), (Words{"annealing"}));
  EXPECT_EQ(offered(here, script, "orchard build --gaps \"\""), (Words{"connected", "loose", "strict", "none"}));
  EXPECT_EQ(offered(here, script, "orchard completion \"\""), (Words{"bash", "zsh"}));
  EXPECT_EQ(offered(here, script, "orchard medial --sweep ver"), (Words{"vertices="}));
  EXPECT_EQ(offered(here, script, "orchard medial --sort-by radius"), (Words{"radius_error_max", "radius_error_mean"}));
  EXPECT_EQ(offered(here, script, "orchard view --color st"), (Words{"structure", "structure_kind"}));
  for (const char* command :
       {"build", "medial", "view", "voronoi", "verify", "inspect", "sample", "compare", "collide"}) {
    const std::string help = here.run({command, "--help"}).out;
    const Words options = offered(here, script, "orchard " + std::string(command) + " --");
    EXPECT_GT(options.size(), 2u) << command;
    std::istringstream words(help);
    for (std::string word; words >> word;) {
      // At the beginning of an option's line alone, where the name may end with a comma or a bracket.
      if (!word.starts_with("--") || help.find("\n  " + word) == std::string::npos) continue;
      const std::string name = word.substr(0, word.find_first_of(",[{"));
      EXPECT_TRUE(options.contains(name)) << command << " " << name;
    }
  }
}

TEST(Completion, MakesAScriptThatZshTakes) {
  if (std::system("command -v zsh > /dev/null") != 0) GTEST_SKIP() << "there is no zsh";
  const Workplace here;
  const std::string script = here.add("_orchard", here.run({"completion", "zsh"}).out);
  EXPECT_EQ(std::system(("zsh -n " + script).c_str()), 0);
}

TEST(Reference, NamesEveryCommandThatTheHelpLists) {
  const Workplace here;
  const std::string page = here.run({"reference", "markdown"}).out, manual = here.run({"reference", "man"}).out;
  std::istringstream help(here.run({"--help"}).out);
  std::size_t commands = 0;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (line == "Commands:") listed = true;
    if (listed && line.empty()) break;
    if (!listed || !line.starts_with("  ") || line[2] == ' ') continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    ++commands;
    EXPECT_NE(page.find("\n## orchard " + name + "\n"), std::string::npos) << name;
    EXPECT_NE(manual.find("\n.SH orchard " + name + "\n"), std::string::npos) << name;
  }
  EXPECT_GE(commands, 10u);
}

}  // namespace
}  // namespace orchard
