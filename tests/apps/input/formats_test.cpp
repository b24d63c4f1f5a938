#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "program.h"
#include "support/shapes.h"

// Meshes of other programs, standard input, scale and unit, and -o with the name of a file.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;
namespace fs = std::filesystem;

std::string bundled(const std::string& name) { return std::string(ORCHARD_TEST_INPUTS) + "/" + name; }
std::string corpus(const std::string& name) { return std::string(ORCHARD_FUZZ_CORPUS) + "/" + name; }

json inspected(const Workplace& here, std::vector<std::string> words) {
  words.insert(words.begin(), "inspect");
  words.emplace_back("--json");
  const Finished run = here.run(words);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return run.exit_code == 0 ? json::parse(run.out) : json();
}

// Two cubes of side 2, one of them mirrored and turned by its node, with vertices of their own for each face.
TEST(Formats, ScenesArePlacedByTheirNodesAndJoinedWithinThem) {
  const Workplace here;
  for (const char* name : {"two-cubes.glb", "two-cubes.gltf"}) {
    const json report = inspected(here, {bundled(name)});
    EXPECT_EQ(report["vertices"], 16) << name;
    EXPECT_EQ(report["components"], 2);
    EXPECT_TRUE(report["solid"].get<bool>());
    EXPECT_NEAR(report["volume"].get<double>(), 16, 1e-5);
    EXPECT_EQ(report["unit"], "m");
  }
}

TEST(Formats, UnitsAreTheFilesUntilTheUserSaysOtherwise) {
  const Workplace here;
  const json report = inspected(here, {bundled("cube-inch.3mf")});
  EXPECT_NEAR(report["volume"].get<double>(), 8, 1e-5);
  EXPECT_EQ(report["unit"], "in");
  const json scaled = inspected(here, {bundled("cube-inch.3mf"), "--scale", "25.4", "--unit", "mm"});
  EXPECT_NEAR(scaled["volume"].get<double>(), 8 * 25.4 * 25.4 * 25.4, 0.1);
  EXPECT_EQ(scaled["unit"], "mm");
  EXPECT_EQ(scaled["reading"]["scale"], 25.4);
  EXPECT_FALSE(inspected(here, {bundled("cube-inch.3mf"), "--scale", "2"}).contains("unit"));
}

TEST(Formats, SimulationMeshesGoThroughACommand) {
  const Workplace here;
  const Finished run = here.run(
      {"sample", corpus("msh/two-msh41-1.msh"), "-o", (here / "points.xyz").string(), "--samples", "100", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(json::parse(run.out)["reading"]["volume_cells"].get<int>(), 10);
  EXPECT_TRUE(fs::exists(here / "points.xyz"));
  EXPECT_FALSE(fs::exists(here / "two-msh41-1-sample.json"));
}

std::string sphere_points(bool normals) {
  std::string text;
  const TriangleMesh ball = test::icosphere(3, 2);
  for (const Point& p : ball.vertices) {
    for (int i = 0; i < (normals ? 6 : 3); ++i) text += std::to_string(p[i % 3]) + " ";
    text += "\n";
  }
  return text;
}

TEST(Formats, PointsWithNormalsBecomeASurfaceAndOthersAreRefused) {
  const Workplace here;
  const Finished run = here.run({"sample", here.add("scan.xyz", sphere_points(true)), "-o", (here / "out").string(),
                                 "--samples", "100", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json points = json::parse(run.out)["reading"]["from_points"];
  EXPECT_EQ(points["points"], 642);
  EXPECT_LT(points["max_from_points"].get<double>(), points["spacing"].get<double>());
  EXPECT_LE(points["mean_from_points"].get<double>(), points["max_from_points"].get<double>());
  const Finished refused =
      here.run({"sample", here.add("bare.xyz", sphere_points(false)), "-o", (here / "out2").string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("line 1: points without normals"), std::string::npos) << refused.err;
  EXPECT_TRUE(test::is_one_line_error(refused.err));
}

// By a shell, since the test's own standard input is not the program's.
int through_a_pipe(const std::string& input, const std::string& words, const fs::path& out, const fs::path& err) {
  const std::string line = std::string(ORCHARD_PROGRAM) + " " + words + " < '" + input + "' > '" + out.string() +
                           "' 2> '" + err.string() + "'";
  return std::system(line.c_str()) / 256;
}
std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(StandardInput, IsReadLikeAFileAndNamedInMessages) {
  const Workplace here;
  const std::string box = here.add("box.obj", test::box(Point(0, 0, 0), Point(3, 2, 1)));
  const fs::path out = here / "stdout", err = here / "stderr";
  ASSERT_EQ(through_a_pipe(box, "inspect - --format obj --json", out, err), 0) << content(err);
  const json report = json::parse(content(out));
  EXPECT_NEAR(report["volume"].get<double>(), 6, 1e-12);
  EXPECT_EQ(report["provenance"]["run"]["paths"][0], "-");
  const std::string sweep = "medial - --format obj -o '" + (here / "sweep").string() +
                            "' --raw --samples 100 --quality-samples 200 --sweep 'prune angle=0,40'";
  EXPECT_EQ(through_a_pipe(box, sweep, out, err), 0) << content(err);
  EXPECT_EQ(through_a_pipe(box, "inspect - --format stl", out, err), 2);
  EXPECT_NE(content(err).find("orchard: standard input"), std::string::npos) << content(err);
  EXPECT_EQ(through_a_pipe(box, "inspect -", out, err), 2);
  EXPECT_NE(content(err).find("--format NAME is needed"), std::string::npos) << content(err);
  EXPECT_EQ(through_a_pipe("/dev/null", "inspect - --format obj", out, err), 2);
  EXPECT_NE(content(err).find("it is empty"), std::string::npos) << content(err);
}

TEST(SingleFile, IsWrittenAloneByItsEnding) {
  const Workplace here;
  const std::string box = here.add("box.obj", test::box(Point(0, 0, 0), Point(3, 2, 1)));
  for (const char* name : {"axis.ma", "axis.npz", "axis.ply"}) {
    const Finished run = here.run({"medial", box, "-o", (here / name).string(), "--samples", "300", "--no-views"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(fs::is_regular_file(here / name)) << name;
  }
  const Finished spheres = here.run({"spheres", box, "-o", (here / "set.csv").string(), "-n", "5", "--effort", "low"});
  EXPECT_EQ(spheres.exit_code, 0) << spheres.err;
  EXPECT_TRUE(fs::is_regular_file(here / "set.csv"));
  EXPECT_EQ(
      here.run({"build", box, "-o", (here / "box.orchard").string(), "--method", "octree", "--depth", "2"}).exit_code,
      0);
  EXPECT_TRUE(fs::is_regular_file(here / "box.orchard"));
  // The input, the files named, and nothing else.
  std::size_t entries = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator((here / "box.obj").parent_path())) ++entries;
  EXPECT_EQ(entries, 6u);
  EXPECT_EQ(here.run({"medial", box, "-o", (here / "none/axis.ma").string()}).exit_code, 2);
}

}  // namespace
}  // namespace orchard
