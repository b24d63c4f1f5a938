#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

std::vector<std::string> quick(const std::string& mesh, const std::string& folder,
                               const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"spheres", mesh, "-o", folder, "--effort", "low", "--no-views", "-n", "6"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Spheres, AreWrittenInEveryFormatThatAuditReads) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), folder = (here / "out").string();
  const Finished run = here.run(quick(mesh, folder, {"--export", "json,csv,urdf,yaml", "--tree"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("PROMISED: every point of the surface lies in a sphere; proven"), std::string::npos)
      << run.out;
  for (const char* file : {"l-set.txt", "l-set.csv", "l-set-spheres.json", "l-set.yml", "l-set.orchard"}) {
    const Finished audit = here.run({"audit", folder + "/" + file, mesh, "--json"});
    EXPECT_EQ(audit.exit_code, 0) << file << audit.err;
    EXPECT_EQ(json::parse(audit.out)["sets"][0]["spheres"], 6) << file;
  }
  EXPECT_NE(here.files("out").at("l-set.urdf").find("<sphere radius="), std::string::npos);
  EXPECT_EQ(here.run({"verify", folder + "/l-set.orchard", mesh}).exit_code, 0);
}

TEST(Spheres, EndWithFiveWhereTheErrorCannotBeReachedAndWriteTheBestSet) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), folder = (here / "out").string();
  const Finished run = here.run(quick(mesh, folder, {"--error", "0.01", "--json"}));
  EXPECT_EQ(run.exit_code, 5);
  EXPECT_FALSE(json::parse(run.out)["promise"]["kept"].get<bool>());
  EXPECT_TRUE(here.files("out").contains("l-set.txt"));
}

TEST(Spheres, RefuseNumbersOutOfRangeOpenMeshesAndWhatIsOfNoUse) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  const std::string folder = (here / "out").string();
  for (const std::vector<std::string>& more : {std::vector<std::string>{"-n", "0"},
                                               {"-n", "2001"},
                                               {"-n", "6", "--fit", "inside", "--padding", "1"},
                                               {"-n", "6", "--fit", "balanced", "--tree"}}) {
    std::vector<std::string> arguments{"spheres", mesh, "-o", folder};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << more.back();
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
  TriangleMesh holed = test::icosphere(2);
  for (int i = 0; i < 120; ++i) holed.triangles.pop_back();
  const Finished run = here.run({"spheres", here.add("holed.obj", holed), "-o", folder});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("--wrap"), std::string::npos) << run.err;
  EXPECT_TRUE(here.files("out").empty());
}

}  // namespace
}  // namespace orchard
