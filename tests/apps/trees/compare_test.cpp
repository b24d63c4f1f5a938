#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

struct Built {
  Workplace here;
  std::string mesh, folder;
  Built() : mesh(here.add("box.obj", test::box(Point(-1, -1, -1), Point(1, 1, 1)))), folder((here / "out").string()) {
    const Finished run = here.run({"build", mesh, "-o", folder, "--method", "octree", "--depth", "2", "--no-views",
                                   "--quiet", "--export", "json,urdf", "--export-level", "1"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
};

TEST(Compare, GivesTheSameFiguresForATreeInEveryFormat) {
  const Built built;
  const Finished run = built.here.run({"compare", built.mesh, built.folder + "/box.orchard", built.folder + "/box.sph",
                                       built.folder + "/box-spheres.json", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  ASSERT_EQ(report["files"].size(), 3);
  for (const json& file : report["files"]) {
    ASSERT_EQ(file["levels"].size(), 3);
    const json& octants = file["levels"][1];
    // Eight balls of radius sqrt(3)/2 around the octants' centres stand (sqrt(3) - 1)/2 outside.
    EXPECT_EQ(octants["spheres"], 8);
    EXPECT_NEAR(octants["max_inaccuracy"].get<double>(), (std::sqrt(3.0) - 1) / 2, 1e-3);
    EXPECT_NEAR(octants["outside_volume_over_solid"].get<double>(), 0.821445, 0.02);
    EXPECT_EQ(octants["triangles_not_proven_covered"], 0);
  }
  EXPECT_TRUE(report["files"][0]["tree"].get<bool>());
  EXPECT_FALSE(report["files"][2]["tree"].get<bool>());
}

TEST(Compare, ReadsListsOfSpheresByLevelAndSaysWhatTheyLeaveUncovered) {
  const Built built;
  const std::string lists =
      built.here.add("foam.json", R"([{"spheres": [{"origin": [0, 0, 0], "radius": 2}]}, [[0, 0, 0, 1.5]]])");
  const Finished run = built.here.run({"compare", built.mesh, lists, "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json levels = json::parse(run.out)["files"][0]["levels"];
  EXPECT_NEAR(levels[0]["max_inaccuracy"].get<double>(), 1, 1e-3);
  EXPECT_EQ(levels[0]["triangles_not_proven_covered"], 0);
  EXPECT_EQ(levels[1]["triangles_not_proven_covered"], 12);
}

TEST(Compare, DrawsThePlotAndPrintsTheTable) {
  const Built built;
  const std::string plot = (built.here / "plot.svg").string();
  const Finished run = built.here.run({"compare", built.mesh, built.folder + "/box.sph", "--plot", plot});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("box.sph"), std::string::npos);
  EXPECT_TRUE(built.here.files("").contains("plot.svg"));
}

TEST(Compare, RefusesWhatIsNoListOfSpheresInOneLine) {
  const Built built;
  const std::string bad = built.here.add("bad.json", R"([{"spheres": [{"radius": 2}]}])");
  const Finished run = built.here.run({"compare", built.mesh, bad});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("bad.json"), std::string::npos);
}

TEST(Build, ExportsTheSpheresOfALevelAsALink) {
  const Built built;
  const std::string urdf = built.here.files("out").at("box.urdf");
  std::size_t spheres = 0;
  for (std::size_t at = urdf.find("<sphere"); at != std::string::npos; at = urdf.find("<sphere", at + 1)) ++spheres;
  EXPECT_EQ(spheres, 8);
  EXPECT_NE(urdf.find("<link name=\"box\">"), std::string::npos);
}

TEST(Build, RefusesARegionThatIsNone) {
  const Built built;
  for (const char* region : {"1,2,3", "1,2,3,4", "1,2,3,0=1", "1,2,3,4=x"}) {
    const Finished run = built.here.run({"build", built.mesh, "-o", built.folder, "--region", region});
    EXPECT_EQ(run.exit_code, 2) << region;
    EXPECT_NE(run.err.find("--region"), std::string::npos) << region;
  }
}

}  // namespace
}  // namespace orchard
