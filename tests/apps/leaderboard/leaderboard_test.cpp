#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Finished;
using test::Workplace;

constexpr const char* kRod =
    "3 2 0\nv 1 1 1 1\nv 3 1 1 1\nv 5 1 1 1\ne 0 1\ne 1 2\n";  // of the box of 6 x 2 x 2 at the origin

void put(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
}

// A rod, axes with all kinds of names, and on request a rod-long.
std::string folder_of_results(const Workplace& here, bool both = false) {
  fs::create_directories(here / "in/results");
  here.add("in/rod.obj", test::box({0, 0, 0}, {6, 2, 2}));
  if (both) here.add("in/rod-long.obj", test::box({0, 0, 0}, {6, 2, 2}));
  put(here / "in/results/rod-some_system-3.ma", kRod);
  if (both) put(here / "in/results/rod-long-other-fast-3.ma", kRod);
  put(here / "in/rod-balls-3.obj", "v 1 1 1 1\nv 3 1 1 1\nv 5 1 1 .99\n");
  put(here / "in/results/unknown-x-3.ma", kRod);
  put(here / "in/results/rod-cut-3.ma", "3 2 0\nv 1 1 1 1\n");
  return (here / "in").string();
}

std::vector<std::string> words(const std::string& in, const std::string& out) {
  return {"leaderboard", in, "-o", out, "--samples", "200", "--quality-samples", "300", "--json"};
}

const json& row_of(const json& report, const std::string& system) {
  for (const json& row : report["rows"])
    if (row["system"] == system) return row;
  ADD_FAILURE() << "no row of " << system;
  return report;
}

TEST(Leaderboard, MeasuresEverySystemAndOrchardAtTheSameNumberOfBalls) {
  const Workplace here;
  const std::string out = (here / "out").string();
  const Finished run = here.run(words(folder_of_results(here, true), out));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["schema"], "orchard-leaderboard-1");
  EXPECT_EQ(row_of(report, "some_system")["model"], "rod");
  EXPECT_EQ(row_of(report, "other-fast")["model"], "rod-long") << "the longest name of a mesh that fits";
  EXPECT_EQ(row_of(report, "balls")["comparable"], false);
  EXPECT_NE(row_of(report, "cut")["refused"].get<std::string>().find("may be cut off"), std::string::npos);
  EXPECT_EQ(row_of(report, "orchard")["balls"], 3);
  EXPECT_EQ(report["skipped"].size(), 1u);
  EXPECT_EQ(report["score"]["pairs"], 2);
  const auto files = here.files("out");
  EXPECT_NE(files.at("leaderboard.md").find("| rod | 3 | orchard | 3 |"), std::string::npos);
  EXPECT_NE(files.at("leaderboard.csv").find("hausdorff_max"), std::string::npos);
  EXPECT_NE(files.at("rod-leaderboard.svg").find("</svg>"), std::string::npos);
}

TEST(Leaderboard, GoesOnWhereItWasAndGivesTheSameBytes) {
  const Workplace here;
  const std::string in = folder_of_results(here), out = (here / "out").string();
  ASSERT_EQ(here.run(words(in, out)).exit_code, 0);
  const std::string first = here.files("out").at("leaderboard.csv");
  // What was kept is taken, not made again.
  const fs::path kept = here / "out/rows/rod-some_system-3.ma.json";
  std::ifstream stream(kept);
  json row = json::parse(stream);
  row["measures"]["hausdorff_max"] = 77;
  put(kept, row.dump());
  const json report = json::parse(here.run(words(in, out)).out);
  EXPECT_EQ(row_of(report, "some_system")["measures"]["hausdorff_max"], 77);
  // Not after the axis has changed.
  put(here / "in/results/rod-some_system-3.ma", std::string(kRod) + "# changed\n");
  ASSERT_EQ(here.run(words(in, out)).exit_code, 0);
  EXPECT_EQ(test::without_provenance(here.files("out").at("leaderboard.csv")), test::without_provenance(first));
}

#ifdef ORCHARD_HAS_VIZ
TEST(Leaderboard, WritesAStateForParaViewWhoseFilesAreThereAndMakesLostOnesAgain) {
  const Workplace here;
  const std::string in = folder_of_results(here, true), out = (here / "out").string();
  ASSERT_EQ(here.run(words(in, out)).exit_code, 0);
  const auto files = here.files("out");
  ASSERT_TRUE(files.contains("rod-worst.pvsm"));
  const std::string& state = files.at("rod-worst.pvsm");
  std::size_t named = 0;
  for (std::size_t at = state.find(out); at != std::string::npos; at = state.find(out, at + 1), ++named) {
    const std::string file = state.substr(at, state.find('"', at) - at);
    EXPECT_TRUE(fs::exists(file)) << file;
  }
  EXPECT_GE(named, 7u) << "the mesh, and two files of each of three axes";
  EXPECT_NE(state.find("some_system, 3 balls"), std::string::npos);
  EXPECT_NE(state.find("CameraLink"), std::string::npos);
  EXPECT_EQ(state.find("not measured"), std::string::npos);
  fs::remove(here / "out/worst/rod-some_system-3.ma-axis.vtp");
  ASSERT_EQ(here.run(words(in, out)).exit_code, 0);
  EXPECT_TRUE(fs::exists(here / "out/worst/rod-some_system-3.ma-axis.vtp"));
}
#endif

TEST(Leaderboard, HasARowForEachBuilderOfOrchardAtEveryNumberOfBalls) {
  const Workplace here;
  std::vector<std::string> both = words(folder_of_results(here), (here / "out").string());
  const json report = json::parse(here.run(both).out);
  EXPECT_EQ(row_of(report, "orchard")["asked"], 3);
  EXPECT_EQ(row_of(report, "orchard-raw")["asked"], 3);
  both.insert(both.end(), {"--builders", "raw", "--force"});
  for (const json& row : json::parse(here.run(both).out)["rows"]) EXPECT_NE(row["system"], "orchard");
}

TEST(Leaderboard, TakesMeshAndSystemFromATable) {
  const Workplace here;
  const std::string in = folder_of_results(here);
  put(here / "in/results.csv", "file,mesh,system,n\nunknown-x-3.ma,rod.obj,from-table,3\n");
  const Finished run = here.run(words(in, (here / "out").string()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(row_of(json::parse(run.out), "from-table")["model"], "rod");
  put(here / "in/results.csv", "file,mesh,system\nunknown-x-3.ma,none.obj,x\n");
  const Finished refused = here.run(words(in, (here / "other").string()));
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("results.csv, line 2: there is no mesh of this name"), std::string::npos) << refused.err;
}

TEST(Leaderboard, RefusesAFolderWithoutMeshesOrAxes) {
  const Workplace here;
  EXPECT_EQ(here.run(words((here / "none").string(), (here / "out").string())).exit_code, 2);
  fs::create_directories(here / "empty");
  EXPECT_EQ(here.run(words((here / "empty").string(), (here / "out").string())).exit_code, 2);
  fs::create_directories(here / "alone");
  here.add("alone/rod.obj", test::box({0, 0, 0}, {6, 2, 2}));
  const Finished run = here.run(words((here / "alone").string(), (here / "out").string()));
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("no axis was found"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace orchard
