// `orchard skeleton`, `orchard segment`, and the former names of pruning options.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/ply_tables.h"
#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

TEST(SkeletonCommand, WritesTheSameCurvesInEveryFormatOnAnyNumberOfThreads) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(32, 16));
  const auto skeleton = [&](const char* threads) {
    const Finished run =
        here.run({"skeleton", mesh, "-o", (here / "out").string(), "--samples", "600", "--json", "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    json report = json::parse(run.out);
    EXPECT_EQ(report["topology"], report["topology_of_solid"]);
    EXPECT_EQ(report["topology"]["loops"], 1);
    EXPECT_TRUE(report["promise"]["kept"].get<bool>());
    EXPECT_EQ(report["edges_left_out_of_swc"], 1);
    EXPECT_GE(report["curves"].size(), 1u);
    return here.files("out");
  };
  const auto one = skeleton("1"), two = skeleton("2");
  EXPECT_EQ(one.at("torus-skeleton.swc"), two.at("torus-skeleton.swc"));
  EXPECT_EQ(one.at("torus-skeleton.graphml"), two.at("torus-skeleton.graphml"));
  for (const char* ending : {".obj", ".csv"}) {
    const std::string name = std::string("torus-skeleton") + ending;
    EXPECT_EQ(test::without_provenance(one.at(name)), test::without_provenance(two.at(name))) << name;
  }
}

TEST(SkeletonCommand, TakesTheOutsideToo) {
  const Workplace here;
  const Finished run = here.run({"skeleton", here.add("box.obj", test::box(Point(0, 0, 0), Point(2, 1, 1))), "-o",
                                 (here / "out").string(), "--samples", "400", "--side", "outside", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["topology"]["cavities"], 1);
  EXPECT_GT(report["closed_sheets"]["triangles"].get<int>(), 0);
}

TEST(SkeletonCommand, RefusesBadOptionsBeforeItBuilds) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1));
  const auto refused = [&](std::vector<std::string> more, const std::string& what) {
    std::vector<std::string> words{"skeleton", mesh, "-o", (here / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 2) << what;
    EXPECT_NE(run.err.find(what), std::string::npos) << run.err;
  };
  refused({"--prune", "depth=3"}, "one of erosion, ratio, angle, scale");
  refused({"--prune", "erosion"}, "MEASURE=VALUE");
  refused({"--prune", "ratio=0.1"}, "ratio: 0.1 is not a number from 0.2 to 0.99");
  refused({"--skeleton-edge", "0"}, "--skeleton-edge");
  refused({"--raw-axis"}, "--raw-axis");
  refused({"--open-rounds", "2", "--side", "outside"}, "--open-rounds has no effect with --side outside");
}

TEST(SegmentCommand, WritesLabelsAndMeshesThatCoverTheSurface) {
  const Workplace here;
  const Finished run =
      here.run({"segment", here.add("box.obj", test::box(Point(0, 0, 0), Point(4, 3, 1))), "-o",
                (here / "out").string(), "--samples", "600", "--triangles", "2000", "--meshes", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  double area = 0;
  for (const json& part : report["parts"]) area += part["area"].get<double>();
  EXPECT_NEAR(area, 2 * (12 + 4 + 3), 1e-9);
  std::size_t triangles = 0;
  for (std::size_t i = 0; i < report["parts"].size(); ++i) {
    char name[64];
    std::snprintf(name, sizeof name, "out/box-segment-%03zu.ply", i);
    triangles += read_mesh(here / name).triangles.size();
  }
  EXPECT_EQ(triangles, report["triangles"].get<std::size_t>());
  const PlyTables tables(here / "out/box-segments.ply");
  EXPECT_EQ(tables.find("face")->find("part")->numbers.size(), triangles);
}

TEST(SegmentCommand, RefusesBadOptions) {
  const Workplace here;
  const std::string mesh = here.add("ball.obj", test::icosphere(1)), out = (here / "out").string();
  EXPECT_EQ(here.run({"segment", mesh, "-o", out, "--neck", "2"}).exit_code, 2);
  EXPECT_EQ(here.run({"segment", mesh, "-o", out, "--by", "colour"}).exit_code, 2);
  EXPECT_EQ(here.run({"segment", (here / "none.obj").string(), "-o", out}).exit_code, 2);
}

TEST(PruneOption, AcceptsItsFormerNamesWithAWarning) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  const auto axis = [&](std::vector<std::string> more, bool warns) {
    std::vector<std::string> words{"medial",    mesh,      "-o",    (here / "out").string(),
                                   "--samples", "300",     "--raw", "--no-views",
                                   "--quiet",   "--accept"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err.find("will be gone in the next version") != std::string::npos, warns) << run.err;
    return here.files("out").at("l.ma");
  };
  const std::string now = axis({"--prune", "angle=40", "--prune", "scale=1.1"}, false);
  EXPECT_EQ(axis({"--prune-angle", "40", "--prune-scale=1.1"}, true), now);
  EXPECT_NE(axis({}, false), now);
  const Finished sweep = here.run({"medial", mesh, "-o", (here / "out").string(), "--raw", "--samples", "200",
                                   "--sweep", "prune-angle=0,30", "--quality-samples", "300", "--quiet"});
  EXPECT_EQ(sweep.exit_code, 0) << sweep.err;
  EXPECT_NE(sweep.err.find("--sweep 'prune angle='"), std::string::npos) << sweep.err;
}

}  // namespace
}  // namespace orchard
