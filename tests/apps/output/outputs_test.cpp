#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "program.h"
#include "support/shapes.h"

// Where the commands write, and what happens where they cannot.
namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

namespace fs = std::filesystem;

struct Models {
  const Workplace here;
  const std::string ball = here.add("ball.obj", test::icosphere(2)), l = here.add("l.obj", test::l_shape());

  // Every command that writes into a folder, on one of the models.
  std::vector<std::vector<std::string>> runs(const std::string& folder) const {
    std::vector<std::vector<std::string>> all;
    for (const std::string& mesh : {ball, l}) {
      all.push_back({"build", mesh, "--samples", "150", "--depth", "1", "--export", "json,urdf"});
      all.push_back({"medial", mesh, "--samples", "150"});
      all.push_back({"medial", mesh, "--sweep", "samples=100", "--quality-samples", "100"});
      all.push_back({"sample", mesh, "--samples", "200"});
      all.push_back({"thickness", mesh, "--samples", "100"});
      all.push_back({"voronoi", mesh, "--samples", "150"});
    }
    for (auto& run : all) run.insert(run.end(), {"-o", (here / folder).string(), "--quiet"});
    return all;
  }
};

TEST(Outputs, OfEveryCommandAndModelHaveNamesOfTheirOwn) {
  const Models models;
  std::map<std::string, std::string> apart;
  std::size_t number = 0;
  for (const auto& run : models.runs("apart")) {
    std::vector<std::string> alone = run;
    const std::string folder = "apart-" + std::to_string(number++);
    *(alone.end() - 2) = (models.here / folder).string();
    const Finished finished = models.here.run(alone);
    ASSERT_EQ(finished.exit_code, 0) << run[0] << finished.err;
    for (const auto& [name, bytes] : models.here.files(folder)) {
      EXPECT_TRUE(name.starts_with("ball") || name.starts_with("l.") || name.starts_with("l-")) << name;
      EXPECT_TRUE(apart.emplace(name, bytes).second) << name << " is written by " << run[0] << " and by another";
    }
  }
  for (const auto& run : models.runs("shared")) ASSERT_EQ(models.here.run(run).exit_code, 0) << run[0];
  const auto shared = models.here.files("shared");
  EXPECT_EQ(shared.size(), apart.size());
  for (const auto& [name, bytes] : apart) {
    ASSERT_TRUE(shared.contains(name)) << name;
    // Some hold times, and ParaView's state the name of its folder.
    const bool varies = name.ends_with(".json") || name.ends_with("-sweep.csv") || name.ends_with("-sweep.svg") ||
                        name.ends_with(".pvsm");
    EXPECT_TRUE(varies || shared.at(name) == bytes) << name;
  }
}

TEST(Outputs, OfTheViewsNameTheFilesBesideThem) {
  const Models models;
  for (const auto& run : models.runs("out")) ASSERT_EQ(models.here.run(run).exit_code, 0) << run[0];
  const auto files = models.here.files("out");
#ifdef ORCHARD_HAS_VIZ
  for (const std::string name : {"ball-build.vtm", "l-build.vtm", "ball-medial.vtm", "l-medial-parts.vtm"}) {
    const std::string& vtm = files.at(name);
    std::size_t count = 0;
    for (std::size_t at = vtm.find("file=\""); at != std::string::npos; at = vtm.find("file=\"", at + 1), ++count) {
      const std::string file = vtm.substr(at + 6, vtm.find('"', at + 6) - at - 6);
      EXPECT_TRUE(files.contains(file)) << file;
      const std::string command = name.find("-medial") != std::string::npos ? "-medial-" : "-build-";
      EXPECT_TRUE(file.starts_with(name.substr(0, name.find('-')) + command)) << file;
    }
    EXPECT_GE(count, name == "ball-medial.vtm" ? 3u : 6u) << name;
  }
#endif
}

TEST(Outputs, NeverTakeAwayAFileThatTheRunDidNotWrite) {
  const Models models;
  fs::create_directory(models.here / "out");
  const std::set<std::string> own{"ball-wrap.obj", "ball-repaired.obj", "ball.urdf", "ball-build-level-2.vtp"};
  for (const std::string& name : own) models.here.add("out/" + name, std::string("the user's " + name));
  for (const auto& run : models.runs("out")) {
    std::vector<std::string> plain = run;
    if (const auto at = std::find(plain.begin(), plain.end(), "--export"); at != plain.end()) plain.erase(at, at + 2);
    ASSERT_EQ(models.here.run(plain).exit_code, 0) << run[0];
  }
  const auto files = models.here.files("out");
  for (const std::string& name : own) EXPECT_EQ(files.at(name), "the user's " + name);
  for (const char* tree : {"out/ball.orchard", "out/ball.sph"})
    EXPECT_EQ(models.here.run({"verify", (models.here / tree).string(), models.ball}).exit_code, 0) << tree;
}

// The mesh is unreadable as well, and the error is not about that: the folder was looked at first.
TEST(Outputs, ThatCannotBeWrittenAreRefusedBeforeTheMeshIsRead) {
  const Workplace here;
  const std::string garbage = here.add("garbage.obj", std::string("f 1 2 3\n"));
  here.add("file", std::string("in the way"));
  fs::create_directories(here / "taken");
  for (const char* name : {"garbage.sph", "garbage-medial.json", "garbage-sweep.csv", "garbage.xyz",
                           "garbage-highest-first.vor", "garbage-build-level-3.vtp", "garbage-repaired.obj"})
    fs::create_directories(here / ("taken/" + std::string(name)));
  const std::vector<std::vector<std::string>> commands{{"build", garbage},
                                                       {"medial", garbage},
                                                       {"medial", garbage, "--sweep", "samples=200"},
                                                       {"sample", garbage},
                                                       {"voronoi", garbage}};
  for (const std::vector<std::string>& command : commands) {
    for (const std::string& folder :
         {(here / "file").string(), (here / "file/below").string(), (here / "taken").string(),
          std::string("/proc/nowhere"), (here / std::string(300, 'x')).string()}) {
      std::vector<std::string> arguments = command;
      arguments.insert(arguments.end(), {"-o", folder});
      const Finished run = here.run(arguments);
      EXPECT_EQ(run.exit_code, 2) << command[0] << " " << folder;
      EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
      EXPECT_NE(run.err.find(folder), std::string::npos) << run.err;
      EXPECT_EQ(run.err.find("garbage.obj:"), std::string::npos) << run.err;
    }
  }
  EXPECT_EQ(here.files(".").at("file"), "in the way");
  EXPECT_FALSE(fs::exists(here / "file/below"));
}

TEST(Outputs, FolderWithoutANameIsRefused) {
  const Workplace here;
  const Finished run = here.run({"build", here.add("l.obj", test::l_shape()), "-o", ""});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
}

TEST(Outputs, FolderIsNotMadeForAMeshThatCannotBeUsed) {
  const Workplace here;
  const std::string garbage = here.add("garbage.obj", std::string("f 1 2 3\n"));
  for (const char* command : {"build", "medial", "sample", "voronoi"}) {
    const Finished run = here.run({command, garbage, "-o", (here / "new/folder").string()});
    EXPECT_EQ(run.exit_code, 2) << command;
    EXPECT_FALSE(fs::exists(here / "new")) << command;
  }
}

TEST(Outputs, ThatAreInputsAreRefused) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), plot = here.add("l.json", std::string("[[[0,0,0,9]]]"));
  const Finished run = here.run({"compare", mesh, plot, "--plot", plot});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  EXPECT_EQ(here.files(".").at("l.json"), "[[[0,0,0,9]]]");
}

TEST(Compare, RefusesAPlotThatCannotBeWrittenBeforeItMeasures) {
  const Workplace here;
  const std::string garbage = here.add("garbage.obj", std::string("f 1 2 3\n"));
  const std::string lists = here.add("lists.json", std::string("[[[0,0,0,9]]]"));
  for (const std::string& plot : {(here / "none/plot.svg").string(), std::string("/proc/plot.svg/x")}) {
    const Finished run = here.run({"compare", garbage, lists, "--plot", plot});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(plot), std::string::npos) << run.err;
  }
}

TEST(Compare, ReadsAllTreesBeforeItMeasuresOne) {
  const Workplace here;
  const std::string garbage = here.add("garbage.obj", std::string("f 1 2 3\n"));
  const std::string good = here.add("good.json", std::string("[[[0,0,0,9]]]")),
                    bad = here.add("bad.json", std::string("["));
  const Finished run = here.run({"compare", garbage, good, bad});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("bad.json"), std::string::npos) << run.err;
}

TEST(Options, ThatContradictEachOtherAreRefusedBeforeTheMeshIsRead) {
  const Workplace here;
  const std::string garbage = here.add("garbage.obj", std::string("f 1 2 3\n")), out = (here / "out").string();
  const std::string points = here.add("points.xyz", std::string("0 0 0\n1 0 0\n0 1 0\n0 0 1\n"));
  const struct {
    std::vector<std::string> arguments;
    const char* named;
  } cases[] = {
      {{"build", garbage, "-o", out, "--export", "urdf", "--export-level", "9", "--depth", "1"}, "--export-level"},
      {{"build", garbage, "-o", out, "--export-level", "1"}, "--export-level"},
      {{"medial", garbage, "-o", out, "--samples", "100", "--edge-samples", "101"}, "--edge-samples"},
      {{"medial", garbage, "-o", out, "--sweep", "nothing=1"}, "--sweep"},
      {{"medial", garbage, "-o", out, "--sweep", "samples=200,100", "--edge-samples", "150"}, "--edge-samples"},
      {{"medial", garbage, "-o", out, "--axis", (here / "none.ma").string()}, "none.ma"},
      {{"medial", garbage, "-o", out, "--points", (here / "none.xyz").string()}, "none.xyz"},
      {{"medial", garbage, "-o", out, "--diagram", (here / "none.vor").string()}, "none.vor"},
      {{"sample", garbage, "-o", out, "--samples", "100", "--edge-samples", "101"}, "--edge-samples"},
      {{"voronoi", garbage, "--samples", "100", "--edge-samples", "101"}, "--edge-samples"},
      {{"voronoi", points, "-o", out, "--cells", "1,4"}, "--cells"},
  };
  for (const auto& [arguments, name] : cases) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
  }
}

TEST(Build, ExportsAllLeavesForALevelBelowTheDeepest) {
  const Workplace here;
  const std::string mesh = here.add("box.obj", test::box(Point(-1, -1, -1), Point(1, 1, 1)));
  const auto spheres = [&](const std::string& level) {
    const Finished run =
        here.run({"build", mesh, "-o", (here / "out").string(), "--method", "octree", "--depth", "3", "--error", "0.5",
                  "--export", "urdf", "--export-level", level, "--quiet", "--no-views"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string urdf = here.files("out").at("box.urdf");
    std::size_t count = 0;
    for (std::size_t at = urdf.find("<sphere"); at != std::string::npos; at = urdf.find("<sphere", at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(spheres("1"), 8u);
  EXPECT_EQ(spheres("3"), 8u);  // the tree has no more than these
}

// --- standard output
// --------------------------------------------------------------------------------------------------

TEST(StandardOutput, ThatCannotBeWrittenIsAFailure) {
  const Models models;
  const std::string out = (models.here / "out").string();
  ASSERT_EQ(models.here.run({"build", models.l, "-o", out, "--depth", "1", "--method", "octree", "--quiet"}).exit_code,
            0);
  const std::string tree = out + "/l.orchard";
  const std::vector<std::vector<std::string>> commands{
      {"build", models.l, "-o", out, "--depth", "1", "--method", "octree"},
      {"sample", models.l, "-o", out, "--samples", "100"},
      {"medial", models.l, "-o", out, "--samples", "300"},
      {"medial", models.l, "-o", out, "--axis", out + "/l.ma", "--quality-samples", "200"},
      {"voronoi", models.l, "--samples", "100"},
      {"inspect", models.l},
      {"inspect", tree},
      {"verify", tree, models.l},
      {"compare", models.l, tree},
      {"collide", tree, tree}};
  for (const std::string where : {"/dev/full", "&-"}) {
    for (const std::vector<std::string>& command : commands) {
      for (const bool with_json : {true, false}) {
        if (!with_json && where == "&-") continue;
        std::vector<std::string> arguments = command;
        if (with_json) arguments.emplace_back("--json");
        const Finished run = models.here.run(arguments, where);
        EXPECT_EQ(run.exit_code, 1) << command[0] << where;
        EXPECT_TRUE(test::is_one_line_error(run.err)) << command[0] << ": " << run.err;
      }
    }
    for (const char* asked : {"--help", "--version"}) EXPECT_EQ(models.here.run({asked}, where).exit_code, 1) << where;
  }
}

TEST(StandardOutput, ThatIsClosedDoesNotGetIntoTheFiles) {
  const Models models;
  const std::vector<std::string> quiet{"sample",    models.l, "-o",     (models.here / "out").string(),
                                       "--samples", "100",    "--quiet"};
  const auto written = [&] {
    auto files = models.here.files("out");
    json report = json::parse(files.at("l-sample.json"));
    report.erase("seconds");
    report["provenance"].erase("run");  // what was typed
    files["l-sample.json"] = report.dump();
    return files;
  };
  ASSERT_EQ(models.here.run(quiet, "&-").exit_code, 0);
  const auto files = written();
  std::vector<std::string> loud = quiet;
  loud.back() = "--json";
  EXPECT_EQ(models.here.run(loud, "&-").exit_code, 1);
  EXPECT_EQ(written(), files);
}

}  // namespace
}  // namespace orchard
