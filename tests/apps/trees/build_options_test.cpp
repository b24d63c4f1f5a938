#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "orchard/geometry/min_ball.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// What tunes an axis tunes the tree that is built from it.
TEST(Build, TakesTheFlagsOfMedial) {
  const Workplace here;
  const std::string mesh = here.add("u.obj", test::u_shape(0.1));
  const std::vector<std::string> common{"build",     mesh,   "-o",         (here / "out").string(),
                                        "--depth",   "1",    "--effort",   "low",
                                        "--samples", "1000", "--no-views", "--json"};
  const auto built = [&](std::vector<std::string> more) {
    more.insert(more.begin(), common.begin(), common.end());
    const Finished run = here.run(more);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  };
  const json plain = built({});
  EXPECT_EQ(plain["options"]["samples"], 1000);
  EXPECT_EQ(plain["medial_axis"]["vertices"], plain["medial_axis"]["vertices_before_pruning"]);
  const json pruned = built({"--prune", "angle=120"});
  EXPECT_LT(pruned["medial_axis"]["vertices"], pruned["medial_axis"]["vertices_before_pruning"]);
  EXPECT_EQ(built({"--gaps", "none"})["gap_repair"]["points_added"], 0);
  EXPECT_GT(plain["gap_repair"]["points_added"], 0);
  EXPECT_NE(built({"--algorithm", "exact"})["medial_axis"]["vertices"], 0);
}

TEST(Build, BuildsFromTheAxisThatMedialWrote) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  // The raw axis: a refined one has vertices on the surface, which are refused.
  ASSERT_EQ(here.run({"medial", mesh, "-o", out, "--samples", "500", "--raw", "--no-views", "--quiet"}).exit_code, 0);
  const Finished run = here.run({"build", mesh, "-o", out, "--from-axis", out + "/l.ma", "--depth", "2", "--effort",
                                 "low", "--samples", "2000", "--no-views", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["imported_axis"]["balls_refused"], 0);
  EXPECT_GT(report["medial_axis"]["vertices"], 100);
  EXPECT_EQ(here.run({"verify", out + "/l.orchard", mesh}).exit_code, 0);
  // A ball outside is refused, and counted.
  here.add("one.ma", std::string("3 1 0\nv 99 0 0 1\nv .5 .5 .5 .5\nv .6 .5 .5 .5\ne 0 1\n"));
  const Finished one = here.run({"build", mesh, "-o", out, "--from-axis", (here / "one.ma").string(), "--depth", "1",
                                 "--method", "merging", "--no-views", "--json"});
  ASSERT_EQ(one.exit_code, 0) << one.err;
  EXPECT_EQ(json::parse(one.out)["imported_axis"]["balls_refused"], 1);
}

TEST(Build, RefusesAnAxisThatItHasNoUseFor) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const std::string points = here.add("p.xyz", std::string("0 0 0\n")), axis = here.add("a.ma", std::string("0 0 0\n"));
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--points", points, "--from-axis", axis},
                                                {"--from-axis", axis, "--method", "octree"},
                                                {"--from-axis", (here / "none.ma").string()},
                                                {"--from-axis", axis},
                                                {"--edge-samples", "200", "--samples", "100"},
                                                {"--segment-angle", "20"}}) {
    std::vector<std::string> arguments{"build", mesh, "-o", out, "--no-views"};
    arguments.insert(arguments.end(), wrong.begin(), wrong.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << wrong[0];
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_FALSE(std::filesystem::exists(here / "out"));
  }
}

TEST(Build, CountsTheSurfacePointsThatItWasGiven) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  ASSERT_EQ(here.run({"sample", mesh, "-o", out, "--samples", "700", "--no-views", "--quiet"}).exit_code, 0);
  const std::string points = here.files("out").at("l.xyz");
  const Finished run = here.run({"build", mesh, "-o", out, "--points", out + "/l.xyz", "--depth", "1", "--effort",
                                 "low", "--no-views", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["options"]["samples"], std::count(points.begin(), points.end(), '\n'));
  const Finished without = here.run(test::quick_build(mesh, out, {"--json"}));
  EXPECT_FALSE(json::parse(without.out)["options"].contains("samples")) << "an octree is built from no points";
}

TEST(Build, TakesTheMinimalBallAsRootUnlessAskedForRittersOne) {
  const Workplace here;
  const TriangleMesh solid = test::l_shape();
  const std::string mesh = here.add("l.obj", solid);
  const double minimal = minimal_ball(solid.vertices).radius, ritter = ritter_ball(solid.vertices).radius;
  ASSERT_GT(ritter, 1.001 * minimal);
  const auto radius = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = test::quick_build(mesh, (here / "out").string(), {"--json"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const json report = json::parse(run.out);
    const double reported = report["mesh"]["bounding_ball"][3].get<double>();
    std::istringstream tree(here.files("out").at("l.sph"));
    double root = 0;
    for (int i = 0; i < 6; ++i) tree >> root;  // "levels branching", then "x y z radius .."
    EXPECT_NEAR(root, reported, 1e-6 * reported);
    return reported;
  };
  EXPECT_DOUBLE_EQ(radius({}), minimal);
  EXPECT_DOUBLE_EQ(radius({"--root-ball", "minimal"}), minimal);
  EXPECT_DOUBLE_EQ(radius({"--root-ball", "ritter"}), ritter);
  EXPECT_EQ(here.run(test::quick_build(mesh, (here / "out").string(), {"--root-ball", "box"})).exit_code, 2);
}

TEST(Build, ExplainsWrongUse) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const std::vector<std::vector<std::string>> cases{{},
                                                    {"grow"},
                                                    {"build"},
                                                    {"build", ball},
                                                    test::quick_build(ball, out, {"--depth", "0"}),
                                                    test::quick_build(ball, out, {"--branching", "1025"}),
                                                    test::quick_build(ball, out, {"--colour"}),
                                                    test::quick_build(ball, out, {"--strict", "--wrap"})};
  for (const auto& arguments : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_TRUE(here.files("out").empty());
  }
  EXPECT_EQ(here.run({"--help"}).exit_code, 0);
  EXPECT_EQ(here.run({"--version"}).exit_code, 0);
}

}  // namespace
}  // namespace orchard
