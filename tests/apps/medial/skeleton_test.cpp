// `orchard skeleton`, `orchard segment`, and the former names of pruning options.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
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

TEST(SkeletonCommand, TakesTheAxisOfAFileInPlaceOfItsOwn) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(24, 12)), axis = (here / "torus.ma").string();
  ASSERT_EQ(here.run({"medial", mesh, "-o", axis, "--samples", "500", "--quiet"}).exit_code, 0);
  const auto curves = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"skeleton", mesh, "-o", (here / "out").string(), "--quiet", "--no-views"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return test::without_provenance(here.files("out").at("torus-skeleton.csv"));
  };
  EXPECT_EQ(curves({"--axis", axis}), curves({"--samples", "500"}));
  EXPECT_EQ(curves({"--axis", axis, "--prune", "erosion=1"}), curves({"--axis", axis}));
  const Finished parts = here.run({"segment", mesh, "-o", (here / "out").string(), "--axis", axis, "--json"});
  ASSERT_EQ(parts.exit_code, 0) << parts.err;
  EXPECT_EQ(json::parse(parts.out)["axis"]["file"], axis);
}

TEST(SkeletonCommand, RefusesTheAxisOfAnotherMesh) {
  const Workplace here;
  const std::string ring = here.add("torus.obj", test::torus(24, 12)), axis = (here / "torus.ma").string(),
                    box = here.add("box.obj", test::box(Point(-3, -3, -1), Point(3, 3, 1))),
                    bar = here.add("bar.obj", test::box(Point(-3, -0.4, -0.4), Point(3, 0.4, 0.4))),
                    balls = here.add("balls.sph", std::string("4 2\n1 0 0 0.35\n0 1 0 0.35\n"));
  ASSERT_EQ(here.run({"medial", ring, "-o", axis, "--samples", "500", "--quiet"}).exit_code, 0);
  const auto refused = [&](const std::string& command, const std::string& mesh, std::vector<std::string> more,
                           const std::string& what) {
    std::vector<std::string> words{command, mesh, "-o", (here / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = here.run(words);
    EXPECT_EQ(run.exit_code, 2) << what;
    EXPECT_NE(run.err.find(what), std::string::npos) << run.err;
  };
  refused("skeleton", box, {"--axis", axis}, "torus.ma: the balls do not lie near the mesh");
  refused("segment", bar, {"--axis", axis}, "torus.ma");
  refused("skeleton", ring, {"--axis", axis, "--side", "outside"}, "torus.ma");
  refused("skeleton", ring, {"--axis", axis, "--samples", "900"}, "--samples has no effect with --axis");
  refused("segment", ring, {"--axis", axis, "--prune", "angle=9"}, "has no effect with --axis");
  refused("skeleton", ring, {"--axis", (here / "none.ma").string()}, "none.ma");
  refused("skeleton", ring, {"--axis", balls}, "balls alone");
  EXPECT_FALSE(std::filesystem::exists(here / "out"));
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

TEST(SegmentCommand, SaysBeforeItBuildsThatAPartCannotBeWritten) {
  const Workplace here;
  const std::string mesh = here.add("box.obj", test::box(Point(0, 0, 0), Point(4, 3, 1)));
  std::filesystem::create_directories(here / "out/box-segment-001.ply");
  const std::vector<std::string> words{"segment", mesh, "-o", (here / "out").string(), "--samples", "300"};
  EXPECT_EQ(here.run(words).exit_code, 0);
  std::vector<std::string> with_meshes = words;
  with_meshes.insert(with_meshes.end(), {"--meshes", "--force"});
  const Finished run = here.run(with_meshes);
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_NE(run.err.find("box-segment-001.ply: the file cannot be written because a folder has this name"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(run.out, "");  // nothing was read yet
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
