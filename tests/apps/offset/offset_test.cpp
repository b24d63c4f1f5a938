#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

TriangleMesh offset_box() { return test::box(Point(0, 0, 0), Point(3, 2, 1)); }

TEST(OffsetCommand, TellsTheBoundsAndHoldsThemAgainstTheTolerance) {
  const Workplace here;
  const Finished run = here.run({"offset", here.add("box.obj", offset_box()), "-o", (here / "out").string(),
                                 "--distance", "0.3", "--tolerance", "3", "--unit", "mm", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_TRUE(report["promise"]["kept"].get<bool>());
  EXPECT_LE(report["error"].get<double>(), report["tolerance"].get<double>());
  EXPECT_EQ(report["unit"], "mm");
  EXPECT_TRUE(check_mesh(read_mesh(here / "out/box-offset.obj")).solid());
  EXPECT_EQ(here.files("out").count("box-offset.json"), 1u);
}

TEST(OffsetCommand, HollowsIntoASingleFile) {
  const Workplace here;
  const Finished run = here.run({"offset", here.add("box.obj", offset_box()), "-o", (here / "hollow.ply").string(),
                                 "--hollow", "2", "--scale", "10", "--tolerance", "3", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_GE(report["min_wall"].get<double>(), 2.0);
  EXPECT_EQ(report["components"], 2);
  EXPECT_NEAR(check_mesh(read_mesh(here / "hollow.ply")).volume, report["volume"].get<double>(), 1e-6);
  EXPECT_FALSE(std::filesystem::exists(here / "box-offset.json"));
}

TEST(OffsetCommand, RefusesBadInputInOneLine) {
  const Workplace here;
  const std::string box = here.add("box.obj", offset_box()), open = here.add("open.obj", test::open_box());
  const std::vector<std::vector<std::string>> cases{{box},
                                                    {box, "--distance", "0"},
                                                    {box, "--distance", "nan"},
                                                    {box, "--distance", "1", "--hollow", "1"},
                                                    {box, "--hollow", "0.6"},
                                                    {box, "--distance", "0.6", "--side", "inside"},
                                                    {box, "--distance", "1", "--tolerance", "0.001"},
                                                    {open, "--distance", "0.1", "--strict"},
                                                    {"none.obj", "--distance", "1"}};
  for (const std::vector<std::string>& words : cases) {
    std::vector<std::string> arguments{"offset"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    arguments.insert(arguments.end(), {"-o", (here / "out").string()});
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.out;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_FALSE(std::filesystem::exists(here / "out"));
  }
}

}  // namespace
}  // namespace orchard
