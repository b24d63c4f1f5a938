#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/min_ball.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// The quick way to a tree.
std::vector<std::string> build(const std::string& mesh, const std::string& folder,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"build", mesh, "-o", folder, "--method", "octree", "--depth", "2", "--no-views"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TriangleMesh holed_ball() {
  TriangleMesh mesh = test::icosphere(2);
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  return mesh;
}

TEST(Build, WritesTheTreeAndItsReport) {
  const Workplace here;
  const Finished run = here.run(build(here.add("ball.obj", test::icosphere(2)), (here / "out").string()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");
  EXPECT_NE(run.out.find("conservative"), std::string::npos);
  const auto files = here.files("out");
  EXPECT_EQ(files.size(), 4u);
  for (const char* name : {"ball.orchard", "ball.sph", "ball.json", "ball-levels.svg"})
    EXPECT_TRUE(files.contains(name)) << name;
  const json report = json::parse(files.at("ball.json"));
  EXPECT_TRUE(report["conservative"].get<bool>());
  EXPECT_TRUE(report["repair"]["lines"].empty());
  EXPECT_FALSE(report.contains("wrap_distance"));
}

TEST(Build, BuildsAMedialTreeAsTheDefault) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(2));
  const Finished run = here.run(
      {"build", mesh, "-o", (here / "out").string(), "--samples", "300", "--depth", "2", "--json", "--no-views"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["options"]["method"], "tightened");
  EXPECT_GT(report["medial_axis"]["vertices"].get<int>(), 0);
}

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
  const json pruned = built({"--prune-angle", "120"});
  EXPECT_LT(pruned["medial_axis"]["vertices"], pruned["medial_axis"]["vertices_before_pruning"]);
  EXPECT_EQ(built({"--gaps", "none"})["gap_repair"]["points_added"], 0);
  EXPECT_GT(plain["gap_repair"]["points_added"], 0);
  EXPECT_NE(built({"--algorithm", "exact"})["medial_axis"]["vertices"], 0);
}

TEST(Build, BuildsFromTheAxisThatMedialWrote) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  ASSERT_EQ(here.run({"medial", mesh, "-o", out, "--samples", "500", "--no-views", "--quiet"}).exit_code, 0);
  const Finished run = here.run({"build", mesh, "-o", out, "--from-axis", out + "/l.ma", "--depth", "2", "--effort",
                                 "low", "--samples", "2000", "--no-views", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["imported_axis"]["balls_refused"], 0);
  EXPECT_GT(report["medial_axis"]["vertices"], 100);
  EXPECT_EQ(here.run({"verify", out + "/l.orchard", mesh}).exit_code, 0);
  // A ball outside is refused, and counted.
  here.add("one.ma", std::string("2 1 0\nv 99 0 0 1\nv .5 .5 .5 .1\ne 0 1\n"));
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

TEST(Build, RefusesOptionsThatWouldHaveNoEffect) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), file = here.add("p.xyz", std::string("0 0 0\n"));
  const struct {
    std::vector<std::string> options;
    const char* fault;
  } cases[] = {
      {{"--method", "octree", "--effort", "low"}, "--effort has no effect on --method octree"},
      {{"--method", "merging", "--effort", "high"}, "it is for tightened and annealing"},
      {{"--method", "annealing", "--objective", "mean"}, "it is for tightened"},
      {{"--closing", "growth"}, "--closing has no effect on --method tightened; it is for merging"},
      {{"--energy", "sum"}, "it is for annealing"},
      {{"--method", "octree", "--gaps", "none"}, "--gaps has no effect on --method octree, which builds from no"},
      {{"--method", "octree", "--samples", "500"}, "it is for tightened and merging"},
      {{"--method", "annealing", "--prune-angle", "20"}, "--prune-angle has no effect on --method annealing"},
      {{"--method", "annealing", "--points", file}, "--points has no effect on --method annealing"},
      {{"--points", file, "--samples", "500"}, "--samples has no effect with --points"},
      {{"--diagram", file, "--gaps", "none"}, "--gaps has no effect with --diagram"},
      {{"--from-axis", file, "--topology", "free"}, "--topology has no effect with --from-axis"}};
  for (const auto& [options, fault] : cases) {
    std::vector<std::string> arguments{"build", mesh, "-o", (here / "out").string(), "--no-views"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << fault;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(fault), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(here / "out"));
  }
  EXPECT_EQ(here.run(build(mesh, (here / "out").string(), {"--seed", "3"})).exit_code, 0);
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
  const Finished without = here.run(build(mesh, out, {"--json"}));
  EXPECT_FALSE(json::parse(without.out)["options"].contains("samples")) << "an octree is built from no points";
}

TEST(Build, TakesTheMinimalBallAsRootUnlessAskedForRittersOne) {
  const Workplace here;
  const TriangleMesh solid = test::l_shape();
  const std::string mesh = here.add("l.obj", solid);
  const double minimal = minimal_ball(solid.vertices).radius, ritter = ritter_ball(solid.vertices).radius;
  ASSERT_GT(ritter, 1.001 * minimal);
  const auto radius = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = build(mesh, (here / "out").string(), {"--json"});
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
  EXPECT_EQ(here.run(build(mesh, (here / "out").string(), {"--root-ball", "box"})).exit_code, 2);
}

TEST(Build, PrintsOnlyJsonWithJsonAndNothingWithQuiet) {
  const Workplace here;
  const std::string mesh = here.add("holed.obj", holed_ball());
  const Finished with_json = here.run(build(mesh, (here / "out").string(), {"--json"}));
  EXPECT_EQ(with_json.exit_code, 0) << with_json.err;
  EXPECT_EQ(with_json.err, "");
  EXPECT_EQ(json::parse(with_json.out)["repair"]["holes_filled"], 1);
  const Finished quiet = here.run(build(mesh, (here / "out").string(), {"--quiet"}));
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST(Build, SaysInALineEachWhatItRepaired) {
  const Workplace here;
  const std::string mesh = here.add("holed.obj", holed_ball());
  const Finished run = here.run(build(mesh, (here / "out").string()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find(mesh + ": turned 1 triangle round"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(mesh + ": filled 1 hole with 1 triangle"), std::string::npos) << run.out;
}

TEST(Build, RepairsNothingWhenStrict) {
  const Workplace here;
  const Finished refused = here.run(build(here.add("holed.obj", holed_ball()), (here / "out").string(), {"--strict"}));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
  EXPECT_EQ(refused.out, "");
  EXPECT_TRUE(here.files("out").empty());
  const Finished accepted =
      here.run(build(here.add("ball.obj", test::icosphere(2)), (here / "out").string(), {"--strict"}));
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
}

TEST(Build, OffersAWrapWhereRepairIsNotEnoughAndBuildsOnIt) {
  const Workplace here;
  const std::string mesh = here.add("open.obj", test::open_box());
  const Finished refused = here.run(build(mesh, (here / "out").string()));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
  EXPECT_NE(refused.err.find("--wrap"), std::string::npos) << refused.err;
  EXPECT_TRUE(here.files("out").empty());

  const Finished wrapped =
      here.run(build(mesh, (here / "out").string(), {"--wrap=0.01", "--wrap-alpha", "0.1", "--json"}));
  ASSERT_EQ(wrapped.exit_code, 0) << wrapped.err;
  const json report = json::parse(wrapped.out);
  const double distance = report["wrap_distance"], over_radius = report["wrap_distance_over_radius"];
  EXPECT_GT(distance, 0.005);
  EXPECT_LT(distance, 0.2);
  EXPECT_FALSE(report.contains("repair"));
  for (const char* levels : {"levels", "octree_levels"}) {
    for (const json& level : report[levels]) {
      for (const std::string name : {"mean_inaccuracy_over_radius", "max_inaccuracy_over_radius"})
        EXPECT_DOUBLE_EQ(level[name + "_including_wrap"].get<double>(), level[name].get<double>() + over_radius);
    }
  }
  TriangleMesh wrap = read_mesh(here / "out/open-wrap.obj");
  EXPECT_TRUE(check_mesh(wrap).solid());
  EXPECT_EQ(wrap.triangles.size(), report["mesh"]["triangles"].get<std::size_t>());
  const Finished verified =
      here.run({"verify", (here / "out/open.orchard").string(), (here / "out/open-wrap.obj").string(), "--quiet"});
  EXPECT_EQ(verified.exit_code, 0) << verified.err;
}

TEST(Build, IsVerifiedAgainstTheFileThatWasRepaired) {
  const Workplace here;
  const std::string mesh = here.add("holed.obj", holed_ball());
  ASSERT_EQ(here.run(build(mesh, (here / "out").string())).exit_code, 0);
  const Finished verified = here.run({"verify", (here / "out/holed.orchard").string(), mesh});
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
}

TEST(Build, WritesTheSameBytesTwiceAndOnAnyNumberOfThreads) {
  const Workplace here;
  const std::string mesh = here.add("holed.obj", holed_ball());
  const auto trees = [&](const std::string& folder, const std::string& threads) {
    const Finished run = here.run({"build", mesh, "-o", (here / folder).string(), "--samples", "300", "--depth", "2",
                                   "--no-views", "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    auto files = here.files(folder);
    files.erase("holed.json");  // holds times
    return files;
  };
  const auto first = trees("first", "1");
  EXPECT_EQ(first.size(), 4u);
  EXPECT_EQ(first, trees("second", "1"));
  EXPECT_EQ(first, trees("third", "3"));
}

TEST(Build, RefusesBadInputInOneLineAndLeavesNothingBehind) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  here.add("file", std::string("in the way"));
  const struct {
    const char* name;
    std::vector<std::string> arguments;
  } cases[] = {
      {"no such file", build((here / "missing.obj").string(), out)},
      {"unknown format", build(here.add("mesh.xyz", std::string("0 0 0\n")), out)},
      {"empty file", build(here.add("empty.obj", std::string()), out)},
      {"no faces", build(here.add("points.obj", std::string("v 0 0 0\n")), out)},
      {"a folder", build(here.add("folder.ply", std::string()), out)},
      {"garbage", build(here.add("garbage.stl", std::string("\x01\x02garbage\xff")), out)},
      {"flat", build(here.add("flat.obj", std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), out)},
      {"a wrap of a point", build(here.add("dot.obj", std::string("v 0 0 0\nf 1 1 1\n")), out, {"--wrap"})},
      {"larger than trees can be",
       build(here.add("vast.obj", test::transformed(test::icosphere(1), 1e20, Vector::Zero())), out)},
      {"smaller than trees can be",
       build(here.add("speck.obj", test::transformed(test::icosphere(1), 1e-20, Vector::Zero())), out)},
      {"an offset that is no number", build(ball, out, {"--wrap=wide"})},
      {"an offset of nothing", build(ball, out, {"--wrap=0"})},
      {"a file where the folder should be", build(ball, (here / "file").string())},
  };
  for (const auto& [name, arguments] : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << name << ": " << run.err;
    EXPECT_EQ(run.out, "") << name;
    EXPECT_TRUE(here.files("out").empty()) << name;
  }
  EXPECT_EQ(here.files(".").at("file"), "in the way");
}

TEST(Build, ExplainsWrongUse) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const std::vector<std::vector<std::string>> cases{{},
                                                    {"grow"},
                                                    {"build"},
                                                    {"build", ball},
                                                    build(ball, out, {"--depth", "0"}),
                                                    build(ball, out, {"--branching", "65"}),
                                                    build(ball, out, {"--colour"}),
                                                    build(ball, out, {"--strict", "--wrap"})};
  for (const auto& arguments : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_TRUE(here.files("out").empty());
  }
  EXPECT_EQ(here.run({"--help"}).exit_code, 0);
  EXPECT_EQ(here.run({"--version"}).exit_code, 0);
}

TEST(Build, LeavesNothingWhereOneOfItsFilesCannotBeWritten) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1));
  std::filesystem::create_directories(here / "out/ball.sph");  // a folder where a file should go
  const Finished run = here.run(build(ball, (here / "out").string()));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  EXPECT_TRUE(here.files("out").empty());
}

}  // namespace
}  // namespace orchard
