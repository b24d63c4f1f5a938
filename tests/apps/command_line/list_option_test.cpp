#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"
#include "support/shapes.h"

// Values that a command line must not have: lists, poses and empty words, refused before anything is done.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// Refused before anything is done, and so without any file.
void expect_refused(const Workplace& here, const std::vector<std::string>& arguments, const std::string& named,
                    const std::string& why = {}) {
  const Finished run = here.run(arguments);
  EXPECT_NE(run.err.find(why), std::string::npos) << why << ": " << run.err;
  EXPECT_EQ(run.exit_code, 2) << named;
  EXPECT_TRUE(test::is_one_line_error(run.err)) << named << ": " << run.err;
  EXPECT_NE(run.err.find(named), std::string::npos) << named << ": " << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_TRUE(here.files("out").empty()) << named;
}

TEST(Values, ListsAreRefusedForAnyItemThatIsMissingOrNone) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const std::string picture = out + ".png";
  const struct {
    std::vector<std::string> command;
    std::string option, good, key;
  } lists[] = {{{"build", ball, "-o", out, "--no-views"}, "--spheres", "8,64", ""},
               {{"build", ball, "-o", out, "--no-views"}, "--export", "json,urdf", ""},
               {{"voronoi", ball, "-o", out}, "--cells", "3,14", ""},
               {{"view", ball, "-o", picture}, "--level", "1,2", ""},
               {{"medial", ball, "-o", out}, "--sweep", "200,400", "samples="}};
  for (const auto& [command, option, good, key] : lists) {
    const std::size_t comma = good.find(',');
    const std::string first = good.substr(0, comma), second = good.substr(comma + 1);
    const auto joined = [&](const char* between) { return std::string(first).append(between).append(second); };
    for (const std::string& list :
         {joined(",,"), good + ",", "," + good, joined(", ,"), std::string(","), std::string(" "), std::string()}) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.end(), {option, key + list});
      expect_refused(here, arguments, option, "empty");
    }
    for (const char* item : {"-7", "nan", "7.5", "99999999999999999999", "7 8"}) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.end(), {option, key + first + "," + item});
      expect_refused(here, arguments, option);
    }
  }
}

TEST(Values, ASweepHasEachValueOnce) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  expect_refused(here, {"medial", ball, "-o", out, "--sweep", "samples=200,400, 200"}, "200 is given twice");
}

TEST(Values, ListsTakeBlanksAroundItemsAndComeAgain) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1));
  const auto cost = [&](const std::vector<std::string>& lists) {
    std::vector<std::string> arguments{"build", "--cost", "--json"};
    for (const std::string& list : lists) arguments.insert(arguments.end(), {"--spheres", list});
    arguments.insert(arguments.end(), {ball, "-o", (here / "out").string()});  // not of the list before them
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    json report = json::parse(run.out);
    report.erase("provenance");
    return report;
  };
  const json plain = cost({"8,64,300"});
  EXPECT_EQ(plain.at("spheres"), 1 + 8 + 64 + 300);
  EXPECT_EQ(cost({"8, 64 ,300"}), plain);
  EXPECT_EQ(cost({"8", "64,300"}), plain);
}

TEST(Values, NumbersOfSpheresThatNoTreeHasAreRefusedBeforeAnythingIsBuilt) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const std::vector<std::string> build{"build", ball, "-o", out};
  const auto with = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = build;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  for (const char* spheres : {"1", "0,5", "2000", "9,8", "8,8", "8,513", "8,4000000000"}) {
    expect_refused(here, with({"--spheres", spheres}), "spheres: ");
    expect_refused(here, with({"--spheres", spheres, "--cost"}), "spheres: ");
  }
  for (const char* method : {"merging", "annealing", "octree"})
    expect_refused(here, with({"--method", method, "--branching", "65", "--cost"}), "between 2 and 64");
}

TEST(Values, AnEmptyWordIsNoValue) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const std::vector<std::string> cases[] = {{"build", ball, "-o", out, "--points", ""},
                                            {"build", ball, "-o", ""},
                                            {"build", "", "-o", out},
                                            {"compare", ball, ball, "--plot", ""},
                                            {"collide", ball, ball, "--pose", ""},
                                            {"view", ball, "-o", out + ".png", "--camera", ""},
                                            {"view", ball, "-o", out + ".png", "--size", ""},
                                            {"simulate", "pile", "--budget", ""}};
  for (const std::vector<std::string>& arguments : cases) expect_refused(here, arguments, "the value is empty");
}

TEST(Values, APoseIsSevenNumbersWithOneCommaBetweenThemAtMost) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "made").string();
  ASSERT_EQ(here.run(test::quick_build(ball, out)).exit_code, 0);
  const std::string tree = out + "/ball.orchard";
  for (const char* pose : {"5 0 0 1 0 0 0", "5,0,0,1,0,0,0", " 5, 0, 0 1 ,0 , 0,0 "})
    EXPECT_EQ(here.run({"collide", tree, tree, "--pose", pose, "--quiet"}).out, "no\n") << pose;
  for (const char* pose : {"5,,0,0,1,0,0,0", "5,0,0,1,0,0,0,", ",5,0,0,1,0,0,0", "5,0,0,1,0,0,nan", "5,0,0,1,0,0,1e999",
                           "5,0,0,1,0,0", "5,0,0,1,0,0,0,0", "5,0,0,0,0,0,0"})
    expect_refused(here, {"collide", tree, tree, "--pose", pose}, "seven finite numbers");
}

}  // namespace
}  // namespace orchard
