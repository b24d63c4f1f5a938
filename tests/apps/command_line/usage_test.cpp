#include <gtest/gtest.h>

#include <regex>

#include <nlohmann/json.hpp>

#include <sstream>
#include <string>

#include "program.h"
#include "support/shapes.h"

// What the program says to a command line, or a file, that makes no sense.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

TEST(Usage, ErrorsAreOneLineAndNameTheHelp) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const struct {
    std::vector<std::string> arguments;
    const char* named;
  } cases[] = {
      {{}, "name a command"},
      {{"build"}, "mesh is required"},
      {{"build", ball}, "--output is required"},
      {{"build", ball, "-o", out, "--depth", "0"}, "--depth"},
      {{"build", ball, "-o", out, "--depth"}, "--depth"},
      {{"build", ball, "-o", out, "--method", "magic"}, "--method"},
      {{"build", ball, "-o", out, "more", "words"}, "more"},
      {{"build", ball, "-o", out, "-x"}, "-x"},
      {{"build", ball, "-o", out, "--strict", "--wrap"}, "--wrap"},
      {{"build", ball, "-o", out, "--region", "1,2"}, "--region"},
      {{"voronoi", ball, "--box", "1", "2"}, "--box"},
      {{"medial", ball, "-o", out, "--gaps", "wide"}, "--gaps"},
      {{"--nothing"}, "--nothing"},
  };
  for (const auto& [arguments, name] : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << name << ": " << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(arguments.size() > 1 ? "\"orchard " + arguments[0] + " --help\"" : "--help"),
              std::string::npos)
        << run.err;
    EXPECT_EQ(run.out, "");
  }
}

// The option of a row "| `--name` | `N` | .. (0 to 100) .. |"; empty where the row is another, or has no range.
std::string option_with_range(const std::string& row) {
  static const std::regex pattern(R"(\| `(?:-\w`, `)?(--[a-z-]+)` \| `N` \|.*\([-+.e0-9]+ to [-+.e0-9]+\).*)");
  std::smatch parts;
  return std::regex_match(row, parts, pattern) ? parts[1].str() : std::string();
}

// All options with a range, from the page of all options.
TEST(Usage, WhatIsNotANumberIsInNoRange) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), heading = "## orchard ";
  std::istringstream page(here.run({"reference", "markdown"}).out);
  std::string line, name;
  int options = 0;
  while (std::getline(page, line)) {
    if (line.starts_with(heading)) name = line.substr(heading.size());
    const std::string option = option_with_range(line);
    if (option.empty() || name == "simulate") continue;
    const Finished run = here.run({name, ball, option, "nan", "-o", (here / "out").string()});
    EXPECT_EQ(run.exit_code, 2) << name << " " << option;
    EXPECT_NE(run.err.find("nan"), std::string::npos) << name << " " << option << ": " << run.err;
    ++options;
  }
  EXPECT_GT(options, 40);
}

TEST(Usage, SuggestsTheCommandThatWasMeant) {
  const Workplace here;
  for (const auto& [typed, meant] : {std::pair{"buld", "build"},
                                     {"biuld", "build"},
                                     {"Build", "build"},
                                     {"inspct", "inspect"},
                                     {"voronoy", "voronoi"},
                                     {"compair", "compare"},
                                     {"verfy", "verify"},
                                     {"samples", "sample"},
                                     {"med", "medial"},
                                     {"colide", "collide"}}) {
    const Finished run = here.run({typed, "x.obj"});
    EXPECT_EQ(run.exit_code, 2) << typed;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find("did you mean \"" + std::string(meant) + "\"?"), std::string::npos) << run.err;
  }
  const Finished nothing = here.run({"transmogrify"});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_EQ(nothing.err.find("did you mean"), std::string::npos) << nothing.err;
  EXPECT_NE(nothing.err.find("--help"), std::string::npos) << nothing.err;
}

TEST(Usage, SuggestsTheOptionThatWasMeant) {
  const Workplace here;
  for (const auto& [typed, meant] : {std::pair{"--dept", "--depth"},
                                     {"--ouput", "--output"},
                                     {"--thread", "--threads"},
                                     {"--method=x", "--method"},
                                     {"--no-view", "--no-views"}}) {
    const Finished run = here.run({"build", "x.obj", "-o", "y", typed, "3"});
    EXPECT_EQ(run.exit_code, 2) << typed;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    if (std::string(typed) != "--method=x") {
      EXPECT_NE(run.err.find("did you mean \"" + std::string(meant) + "\"?"), std::string::npos) << run.err;
    }
  }
}

TEST(Usage, NamesAnOptionOnceWhereItsValueCannotBe) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1));
  for (const auto& [option, value] : {std::pair{"--prune", "angle=200"}, {"--samples", "20.5"}, {"--gaps", "wide"}}) {
    const Finished run = here.run({"medial", ball, "-o", (here / "out").string(), option, value});
    EXPECT_EQ(run.exit_code, 2);
    const std::size_t first = run.err.find(option);
    ASSERT_NE(first, std::string::npos) << run.err;
    EXPECT_EQ(run.err.find(option, first + 1), std::string::npos) << run.err;
    // Of a measure and its value, the value.
    const std::string wrong = value;
    EXPECT_NE(run.err.find(wrong.substr(wrong.find('=') + 1)), std::string::npos) << run.err;
  }
}

TEST(Usage, HelpIsNoError) {
  const Workplace here;
  for (const char* command : {"build", "collide", "verify", "inspect", "sample", "compare", "voronoi", "medial"}) {
    const Finished run = here.run({command, "--help"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("orchard " + std::string(command)), std::string::npos) << run.out;
  }
}

TEST(Usage, AFolderInPlaceOfAFileIsNamed) {
  const Workplace here;
  const std::string folder = (here / "folder.obj").string(), out = (here / "out").string();
  std::filesystem::create_directory(folder);
  const std::string plain = (here / "folder").string();
  std::filesystem::create_directory(plain);
  const std::string mesh = here.add("l.obj", test::l_shape());
  for (const std::string& input : {folder, plain}) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"inspect", input},
                                                      {"build", input, "-o", out},
                                                      {"medial", input, "-o", out},
                                                      {"sample", input, "-o", out},
                                                      {"voronoi", input},
                                                      {"verify", input, mesh},
                                                      {"verify", mesh, input},
                                                      {"compare", mesh, input},
                                                      {"compare", input, mesh},
                                                      {"collide", input, input}}) {
      const Finished run = here.run(arguments);
      EXPECT_EQ(run.exit_code, 2) << arguments[0];
      EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
      EXPECT_NE(run.err.find(input + ": this is a folder"), std::string::npos) << run.err;
    }
  }
}

TEST(Usage, AFileWhoseNameHasTwoLinesGetsAnErrorOfOne) {
  const Workplace here;
  const Finished run = here.run({"inspect", (here / "two\nlines.obj").string()});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
}

TEST(Usage, NumbersAreExplainedOnlyWhereThereAreSome) {
  const Workplace here;
  const std::string out = (here / "out").string();
  TriangleMesh flat;  // a square and the same square from behind
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
  const Finished no_volume = here.run({"build", here.add("flat.obj", flat), "-o", out});
  EXPECT_EQ(no_volume.exit_code, 2);
  EXPECT_NE(no_volume.err.find("it encloses no volume"), std::string::npos) << no_volume.err;
  EXPECT_EQ(no_volume.err.find("count from 0"), std::string::npos) << no_volume.err;
  const Finished open = here.run({"build", here.add("open.obj", test::open_box()), "-o", out});
  EXPECT_NE(open.err.find("count from 0"), std::string::npos) << open.err;
}

TEST(Build, TimesEveryStageUnderANameOfItsOwn) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(2));
  const std::vector<std::vector<std::string>> methods{
      {"octree"},
      {"merging", "--samples", "300", "--closing", "growth"},
      {"annealing", "--effort", "low", "--energy", "sum"},
      {"tightened", "--samples", "300", "--effort", "low", "--objective", "mean"}};
  for (const std::vector<std::string>& options : methods) {
    std::vector<std::string> arguments{"build",   mesh, "-o",         (here / "out").string(),
                                       "--depth", "1",  "--no-views", "--method"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = here.run(arguments);
    const std::string& method = options.front();
    ASSERT_EQ(run.exit_code, 0) << run.err;
    // As printed: "seconds: reading 0.01, octree 0.00, .. in all 0.50".
    const std::size_t begin = run.out.find("seconds:"), end = run.out.find(" in all", begin);
    std::size_t printed = 0;
    for (std::size_t at = begin; at < end; ++at) printed += run.out[at] == ',' ? 1 : 0;
    const json report = json::parse(here.files("out").at("ball.json"));
    EXPECT_EQ(report["seconds"].size(), printed) << method << ": " << report["seconds"].dump();
  }
}

TEST(Medial, WarnsOfNothingThatCannotHelp) {
  const Workplace here;
  // A plate so thin that few points leave gaps.
  const std::string mesh = here.add("u.obj", test::u_shape(0.02)), out = (here / "out").string();
  const auto warning = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"medial", mesh, "-o", out, "--no-views", "--quiet", "--accept"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.err;
  };
  const std::string unmended = warning({"--samples", "200", "--gaps", "none", "--topology", "free"});
  EXPECT_NE(unmended.find("--gaps connected"), std::string::npos) << unmended;

  ASSERT_EQ(here.run({"sample", mesh, "-o", out, "--samples", "200", "--quiet", "--no-views"}).exit_code, 0);
  const std::string points = (here / "out/u.xyz").string();
  ASSERT_EQ(here.run({"voronoi", points, "-o", out, "--quiet"}).exit_code, 0);
  const std::string given = warning({"--diagram", (here / "out/u-highest-first.vor").string(), "--topology", "free"});
  EXPECT_NE(given.find("warning"), std::string::npos) << given;
  EXPECT_EQ(given.find("--gaps"), std::string::npos) << given;
  EXPECT_EQ(given.find("--samples"), std::string::npos) << given;

  const std::string few = warning({"--points", points, "--max-passes", "0", "--topology", "free"});
  EXPECT_NE(few.find("warning"), std::string::npos) << few;
  EXPECT_EQ(few.find("--samples"), std::string::npos) << few;
}

TEST(FormerNames, OfOptionsAndMeasuresAreAcceptedWithAWarning) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  // Each is refused for a reason that shows that the present name was read.
  const struct {
    std::vector<std::string> arguments;
    const char *now, *refused;
  } cases[] = {
      {{"medial", ball, "-o", out, "--curve", "--sweep", "samples=200,400"}, "--error-curve", "--error-curve has no"},
      {{"spheres", ball, "-o", out, "--curve=2,4", "--error", "1"}, "--error-curve", "--error-curve has no effect"},
      {{"medial", ball, "-o", out, "--sort-by", "wires"}, "--sort-by curve_components", "without --sweep"},
      {{"medial", ball, "-o", out, "--sort-by=sheets"}, "--sort-by face_components", "without --sweep"},
      {{"medial", ball, "-o", out, "--sort-by=sheets_between_seams"}, "--sort-by sheet_count", "without --sweep"},
  };
  for (const auto& [arguments, now, refused] : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << now;
    EXPECT_NE(run.err.find(std::string("is called ") + now + " now"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(refused), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace orchard
