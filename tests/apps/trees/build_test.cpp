#include <gtest/gtest.h>

#include <filesystem>
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

TriangleMesh holed_ball() {
  TriangleMesh mesh = test::icosphere(2);
  mesh.triangles.erase(mesh.triangles.begin() + 17);
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  return mesh;
}

TEST(Build, WritesTheTreeAndItsReport) {
  const Workplace here;
  const Finished run = here.run(test::quick_build(here.add("ball.obj", test::icosphere(2)), (here / "out").string()));
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

// But for the warning that the hole is a large one.
TEST(Build, PrintsOnlyJsonWithJsonAndNothingWithQuiet) {
  const Workplace here;
  const std::string mesh = here.add("holed.obj", holed_ball());
  const Finished with_json = here.run(test::quick_build(mesh, (here / "out").string(), {"--json"}));
  EXPECT_EQ(with_json.exit_code, 0) << with_json.err;
  EXPECT_TRUE(test::is_one_line_error(with_json.err)) << with_json.err;
  EXPECT_EQ(json::parse(with_json.out)["repair"]["holes_filled"], 1);
  const Finished quiet = here.run(test::quick_build(mesh, (here / "out").string(), {"--quiet"}));
  EXPECT_EQ(quiet.exit_code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, with_json.err);
}

TEST(Build, SaysInALineEachWhatItRepaired) {
  const Workplace here;
  const std::string mesh = here.add("holed.obj", holed_ball());
  const Finished run = here.run(test::quick_build(mesh, (here / "out").string()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find(mesh + ": turned 1 triangle round"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(mesh + ": filled 1 hole with 1 triangle"), std::string::npos) << run.out;
}

TEST(Build, RepairsNothingWhenStrict) {
  const Workplace here;
  const Finished refused =
      here.run(test::quick_build(here.add("holed.obj", holed_ball()), (here / "out").string(), {"--strict"}));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
  EXPECT_EQ(refused.out, "");
  EXPECT_TRUE(here.files("out").empty());
  const Finished accepted =
      here.run(test::quick_build(here.add("ball.obj", test::icosphere(2)), (here / "out").string(), {"--strict"}));
  EXPECT_EQ(accepted.exit_code, 0) << accepted.err;
}

TEST(Build, OffersAWrapWhereRepairIsNotEnoughAndBuildsOnIt) {
  const Workplace here;
  const std::string mesh = here.add("open.obj", test::open_box());
  const Finished refused = here.run(test::quick_build(mesh, (here / "out").string()));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
  EXPECT_NE(refused.err.find("--wrap"), std::string::npos) << refused.err;
  EXPECT_TRUE(here.files("out").empty());

  const Finished wrapped =
      here.run(test::quick_build(mesh, (here / "out").string(), {"--wrap=0.01", "--wrap-alpha", "0.1", "--json"}));
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
  ASSERT_EQ(here.run(test::quick_build(mesh, (here / "out").string())).exit_code, 0);
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
      {"no such file", test::quick_build((here / "missing.obj").string(), out)},
      {"unknown format", test::quick_build(here.add("mesh.xyz", std::string("0 0 0\n")), out)},
      {"empty file", test::quick_build(here.add("empty.obj", std::string()), out)},
      {"no faces", test::quick_build(here.add("points.obj", std::string("v 0 0 0\n")), out)},
      {"a folder", test::quick_build(here.add("folder.ply", std::string()), out)},
      {"garbage", test::quick_build(here.add("garbage.stl", std::string("\x01\x02garbage\xff")), out)},
      {"flat", test::quick_build(here.add("flat.obj", std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), out)},
      {"a wrap of a point", test::quick_build(here.add("dot.obj", std::string("v 0 0 0\nf 1 1 1\n")), out, {"--wrap"})},
      {"larger than trees can be",
       test::quick_build(here.add("vast.obj", test::transformed(test::icosphere(1), 1e20, Vector::Zero())), out)},
      {"smaller than trees can be",
       test::quick_build(here.add("speck.obj", test::transformed(test::icosphere(1), 1e-20, Vector::Zero())), out)},
      {"an offset that is no number", test::quick_build(ball, out, {"--wrap=wide"})},
      {"an offset of nothing", test::quick_build(ball, out, {"--wrap=0"})},
      {"a file where the folder should be", test::quick_build(ball, (here / "file").string())},
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

TEST(Build, LeavesNothingWhereOneOfItsFilesCannotBeWritten) {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(1));
  std::filesystem::create_directories(here / "out/ball.sph");  // a folder where a file should go
  const Finished run = here.run(test::quick_build(ball, (here / "out").string()));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  EXPECT_TRUE(here.files("out").empty());
}

TEST(Build, SaysWhatItWouldCostAndBuildsNothing) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  const Finished run = here.run({"build", mesh, "-o", out, "--cost"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("up to 585 spheres"), std::string::npos) << run.out;
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(Build, SaysBeforehandWhatALongOneWillCost) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  // Long for all that can be known; the error makes it short.
  const Finished run =
      here.run({"build", mesh, "-o", out, "--method", "octree", "--depth", "8", "--error", "1000", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::size_t cost = run.out.find("up to 19173961 spheres: about");
  ASSERT_NE(cost, std::string::npos) << run.out;
  EXPECT_LT(cost, run.out.find("level  spheres"));
  EXPECT_NE(run.out.find("GB of memory"), std::string::npos) << run.out;
  EXPECT_EQ(here.run(test::quick_build(mesh, out)).out.find("up to"), std::string::npos);
}

}  // namespace
}  // namespace orchard
