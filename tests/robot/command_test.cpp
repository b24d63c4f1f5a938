#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "apps/program.h"
#include "programs.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::has;
using test::is_installed;
using test::Workplace;

const std::string kArm = ORCHARD_DATA_DIR "/desk-arm.urdf";

std::vector<std::string> quick(const std::string& urdf, const std::string& folder,
                               const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments{"robot", urdf,         "-o",           folder,     "--effort",
                                     "low",   "--no-views", "--no-picture", "--states", "200"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(RobotCommand, MakesClosedSpheresInEveryFormatThatAuditReads) {
  const Workplace here;
  const std::string folder = (here / "out").string();
  const Finished run =
      here.run(quick(kArm, folder,
                     {"--spheres", "40", "--export",
                      "curobo,curobo07,xrdf,srdf,urdf,vamp,mjcf,ballpark,morphit,foam,csv,json", "--trees"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(has(run.out, "PROMISED")) << run.out;
  EXPECT_TRUE(has(run.out, "curved primitives")) << run.out;
  for (const char* file : {"desk-arm-curobo.yml", "desk-arm-curobo07.yml", "desk-arm.xrdf", "desk-arm.srdf",
                           "desk-arm-spheres.urdf", "desk-arm-vamp.json", "desk-arm.xml", "desk-arm-ballpark.json",
                           "desk-arm-spheres.csv", "desk-arm-spheres.json", "."}) {
    const Finished audit = here.run({"audit", folder + "/" + file, kArm, "--json"});
    ASSERT_EQ(audit.exit_code, 0) << file << ": " << audit.err;
    const json whole = json::parse(audit.out)["sets"][0]["whole"];
    EXPECT_EQ(whole["spheres"], 40) << file;
    EXPECT_EQ(whole["links"], 9) << file;
    EXPECT_EQ(whole["open_share"][1], 0) << file;
  }
  const auto files = here.files("out");
  EXPECT_TRUE(files.contains("desk-arm-tree-upper arm.orchard"));
  EXPECT_TRUE(has(files.at("desk-arm.srdf"), "reason=\"Adjacent\""));
  EXPECT_TRUE(has(files.at("desk-arm.srdf"), "200 joint states"));
  if (is_installed("check_urdf")) {
    EXPECT_EQ(std::system(("check_urdf '" + folder + "/desk-arm-spheres.urdf' > /dev/null").c_str()), 0);
  }
}

TEST(RobotCommand, GivesTheSameBytesForTheSameInput) {
  const Workplace here;
  for (const char* folder : {"a", "b"})
    ASSERT_EQ(here.run(quick(kArm, (here / folder).string(),
                             {"--spheres", "12", "--threads", folder == std::string("a") ? "1" : "2"}))
                  .exit_code,
              0);
  auto a = here.files("a"), b = here.files("b");
  a.erase("desk-arm-robot.json");  // has times
  b.erase("desk-arm-robot.json");
  EXPECT_EQ(a, b);
}

TEST(RobotCommand, SharesTheBudgetAsAskedFor) {
  const Workplace here;
  const Finished run =
      here.run(quick(kArm, (here / "out").string(),
                     {"--spheres", "20", "--link", "gripper=4", "--fit-link", "base=balanced", "--json"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["whole"]["spheres"], 20);
  for (const json& link : report["links"]) {
    if (link["link"] == "gripper") {
      EXPECT_EQ(link["spheres"], 4);
    }
    EXPECT_EQ(link["fit"], link["link"] == "base" ? "balanced" : "cover");
  }
}

TEST(RobotCommand, WritesSpheresThatAreThereInOtherFormats) {
  const Workplace here;
  const std::string spheres = here.add("s.csv", "x,y,z,r,link\n0,0,0.02,0.2,base\n0,0,0,0.03,wrist\n");
  const Finished run = here.run({"robot", kArm, "-o", (here / "out").string(), "--from", spheres, "--export", "xrdf",
                                 "--no-views", "--no-picture", "--states", "0"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const Finished audit = here.run({"audit", (here / "out/desk-arm.xrdf").string(), kArm});
  EXPECT_EQ(audit.exit_code, 3);
  EXPECT_TRUE(has(audit.out, "OPEN: 8 of 9 links")) << audit.out;
}

TEST(RobotCommand, RefusesBadInputInOneLineAndLeavesNothingBehind) {
  const Workplace here;
  const std::string folder = (here / "out").string();
  const std::string missing = here.add("m.urdf",
                                       "<robot><link name='a'><collision><geometry><mesh filename='x.stl'/></geometry>"
                                       "</collision></link></robot>");
  const std::string none = here.add("n.urdf", "<robot><link name='a'/></robot>");
  const std::string bad_mesh = here.add("b.urdf",
                                        "<robot><link name='a'><collision><geometry><mesh filename='b.stl'/></geometry>"
                                        "</collision></link></robot>");
  here.add("b.stl", "solid broken\nfacet");
  const std::string csv = here.add("t.csv", "turn,none\n0,0\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
      {quick(missing, folder), "x.stl"},
      {quick(none, folder), "no link has collision geometry"},
      {quick(bad_mesh, folder), "b.stl"},
      {quick(kArm, folder, {"--spheres", "5"}), "--spheres 9"},
      {quick(kArm, folder, {"--link", "hand=3"}), "no link hand"},
      {quick(kArm, folder, {"--link", "base=none"}), "--link base=none"},
      {quick(kArm, folder, {"--fit-link", "base=tight"}), "cover, inside or balanced"},
      {quick(kArm, folder, {"--joints", "lift"}), "NAME=VALUE"},
      {quick(kArm, folder, {"--joints", "grip too=0"}), "grip too"},
      {quick(kArm, folder, {"--tool-frame", "hand"}), "hand"},
      {quick(kArm, folder, {"--trajectory", csv}), "t.csv, line 1"},
      {quick(kArm, folder, {"--from", csv}), "--effort has no effect"},
      {{"audit", csv, kArm}, "t.csv"},
      {{"audit", here.add("u.csv", "x,y,z,r,link\n0,0,0,1,elsewhere\n"), kArm}, "no sphere belongs to a link"},
      {{"audit", here.add("w.txt", "0 0 0 1\n"), here.add("box.obj", test::box(Point(0, 0, 0), Point(1, 1, 1))),
        "--visual"},
       "--visual has no effect"}};
  for (const auto& [arguments, fault] : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.out << run.err;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_TRUE(has(run.err, fault)) << fault << " in " << run.err;
    EXPECT_TRUE(here.files("out").empty());
  }
}

#ifdef ORCHARD_HAS_VIZ
TEST(RobotCommand, PlaysATrajectory) {
  const Workplace here;
  const std::string csv = here.add("t.csv", "time,lift,bend\n0,0,0\n0.5,0.3,1\n1,0.6,2\n");
  std::vector<std::string> arguments = quick(kArm, (here / "out").string(), {"--spheres", "9", "--trajectory", csv});
  ASSERT_EQ(here.run(arguments).exit_code, 0);
  const auto files = here.files("out");
  EXPECT_TRUE(has(files.at("desk-arm-trajectory.pvd"), "timestep=\"0.5\""));
  EXPECT_TRUE(files.contains("desk-arm-frame-0002-spheres.vtp"));
  EXPECT_NE(files.at("desk-arm-frame-0000-mesh.vtp"), files.at("desk-arm-frame-0002-mesh.vtp"));
}
#endif

}  // namespace
}  // namespace orchard
