#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

std::size_t lines(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

TEST(Medial, WritesTheAxisItsGraphAndAReport) {
  const Workplace here;
  const Finished run = here.run({"medial", here.add("u.obj", test::u_shape(0.05)), "-o", (here / "out").string(),
                                 "--samples", "800", "--report", "--quality-samples", "2000", "--json", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["build"]["gap_repair"]["faces_still_crossing"], 0);
  EXPECT_EQ(report["topology"], report["topology_of_solid"]);
  EXPECT_TRUE(report["quality"]["topology_right"].get<bool>());
  EXPECT_LT(report["quality"]["coverage_over_diagonal"]["mean"].get<double>(), 0.01);
  EXPECT_TRUE(report["quality"]["stability"]["hausdorff"].is_number());
  const auto files = here.files("out");
  EXPECT_EQ(json::parse(files.at("u-medial.json")), report);
  EXPECT_GT(lines(files.at("u.ma")), 800u);
  EXPECT_NE(files.at("u.graphml").find("</graphml>"), std::string::npos);
}

TEST(Medial, RefinesTheAxisUnlessTheRawOneIsAskedFor) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  const auto run = [&](const std::string& folder, const std::vector<std::string>& more) {
    std::vector<std::string> words{"medial",    mesh,     "-o",        (here / folder).string(),
                                   "--samples", "500",    "--report",  "--quality-samples",
                                   "2000",      "--json", "--no-views"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished finished = here.run(words);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return json::parse(finished.out);
  };
  const json refined = run("refined", {"--open-rounds", "0"}), raw = run("raw", {"--raw"}), no = run("no", {"--refine", "no"});
  EXPECT_TRUE(raw["build"]["refinement"].is_null());
  EXPECT_EQ(here.files("raw").at("l.ma"), here.files("no").at("l.ma"));
  EXPECT_EQ(refined["build"]["refinement"]["vertices_before"], raw["build"]["vertices"]);
  EXPECT_GT(refined["build"]["refinement"]["vertices_on_sharp_edges"], 50);
  const auto max = [](const json& report, const char* metric) {
    return report["quality"][metric]["max"].get<double>();
  };
  EXPECT_LT(max(refined, "radius_error_over_diagonal"), 1e-9);
  EXPECT_LT(max(refined, "protrusion_over_diagonal"), 0.2 * max(raw, "protrusion_over_diagonal"));
  EXPECT_LT(max(refined, "coverage_over_diagonal"), max(raw, "coverage_over_diagonal"));
  EXPECT_TRUE(refined["quality"]["topology_right"].get<bool>());
  EXPECT_EQ(here.run({"medial", mesh, "-o", (here / "x").string(), "--border-loss", "-1"}).exit_code, 2);
}

TEST(Medial, JudgesTheFileThatItWroteAsItJudgedTheAxis) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const Finished built = here.run(
      {"medial", mesh, "-o", out, "--samples", "500", "--report", "--quality-samples", "2000", "--json", "--no-views"});
  ASSERT_EQ(built.exit_code, 0) << built.err;
  const Finished judged = here.run({"medial", mesh, "-o", (here / "other").string(), "--axis", out + "/l.ma",
                                    "--quality-samples", "2000", "--json"});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  json first = json::parse(built.out)["quality"], second = json::parse(judged.out)["quality"];
  first.erase("stability");
  second.erase("stability");
  EXPECT_EQ(first, second);
  EXPECT_TRUE(here.files("other").contains("l-quality.json"));
}

TEST(Medial, SweepsSayHowTightTheTreeOfEachAxisIs) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const Finished run = here.run({"medial", mesh, "-o", out, "--sweep", "samples=400,800", "--tree", "merging",
                                 "--tree-depth", "2", "--quality-samples", "200", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json runs = json::parse(run.out)["runs"];
  ASSERT_EQ(runs.size(), 2u);
  for (const json& row : runs) {
    EXPECT_GT(row["level_2_spheres"], row["level_1_spheres"]);
    EXPECT_LT(row["level_2_mean"], row["level_1_mean"]);
    EXPECT_LE(row["level_2_mean"], row["level_2_max"]);
    EXPECT_LT(row["level_2_outside"], row["level_1_outside"]);
  }
  EXPECT_NE(here.files("out").at("l-sweep.csv").find(",level_1_spheres,level_1_mean,level_1_max,level_1_outside,"),
            std::string::npos);
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--tree", "merging"}).exit_code, 2);
}

TEST(Medial, TakesTheUsersPoints) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  ASSERT_EQ(here.run({"sample", mesh, "-o", (here / "s").string(), "--samples", "400", "--no-views"}).exit_code, 0);
  const std::string points = (here / "s/l.xyz").string();
  const Finished run =
      here.run({"medial", mesh, "-o", (here / "out").string(), "--points", points, "--json", "--no-views"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["build"]["points"].get<std::size_t>(), lines(here.files("s").at("l.xyz")));
  EXPECT_LT(report["points_moved_at_most"].get<double>(), 1e-12);
  const std::string bad = here.add("bad.xyz", std::string("0 0 0\n1 0 x\n"));
  const Finished refused = here.run({"medial", mesh, "-o", (here / "out").string(), "--points", bad});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("line 2"), std::string::npos) << refused.err;
}

TEST(Medial, TakesTheUsersDiagramAsItIs) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  ASSERT_EQ(here.run({"sample", mesh, "-o", (here / "s").string(), "--samples", "400", "--no-views"}).exit_code, 0);
  const std::string points = (here / "s/l.xyz").string();
  const Finished made = here.run({"voronoi", points, "--algorithm", "exact", "-o", (here / "v").string(), "--quiet"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string diagram = (here / "v/l-exact.vor").string();
  const auto axis = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"medial", mesh, "-o", (here / "out").string(), "--raw", "--quiet", "--no-views"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return here.files("out").at("l.ma");
  };
  const std::string own = axis({"--diagram", diagram});
  EXPECT_GT(lines(own), 100u);
  EXPECT_EQ(own.substr(0, own.find('\n')), axis({"--points", points, "--gaps", "none"}).substr(0, own.find('\n')));

  const std::string other = here.add("b.obj", test::icosphere(1));
  const Finished off = here.run({"medial", other, "-o", (here / "out").string(), "--diagram", diagram});
  EXPECT_EQ(off.exit_code, 2);
  EXPECT_NE(off.err.find("off the mesh"), std::string::npos) << off.err;
  EXPECT_EQ(
      here.run({"medial", mesh, "-o", (here / "out").string(), "--diagram", diagram, "--points", points}).exit_code, 2);
}

TEST(Medial, SweepsAllCombinationsIntoOneTableAndAPlotForEachMetric) {
  const Workplace here;
  const Finished run =
      here.run({"medial", here.add("l.obj", test::l_shape()), "-o", (here / "out").string(), "--sweep",
                "samples=200,400", "--sweep", "prune=0,30,60", "--quality-samples", "1000", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const auto files = here.files("out");
  const std::string& csv = files.at("l-sweep.csv");
  EXPECT_EQ(lines(csv), 7u);
  EXPECT_EQ(csv.substr(0, 20), "samples,prune-angle,");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','),
            7 * std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n')), ','));
  for (const char* metric : {"coverage_max", "protrusion_mean", "stability_max", "economy_spheres", "seconds"}) {
    const std::string& svg = files.at("l-sweep-" + std::string(metric) + ".svg");
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
    EXPECT_NE(svg.find("prune-angle 30"), std::string::npos);
  }
}

TEST(Medial, GivesTheSameBytesOnAnyNumberOfThreads) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(20, 10));
  const auto axis = [&](const char* threads) {
    const Finished run = here.run({"medial", mesh, "-o", (here / "out").string(), "--samples", "400", "--quiet",
                                   "--no-views", "--prune-angle", "20", "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return here.files("out").at("torus.ma");
  };
  EXPECT_EQ(axis("1"), axis("3"));
}

// Two boxes that cut each other: no gap between their sheets could be mended.
TriangleMesh crossed_boxes() {
  return test::joined({test::box({0, 0, 0}, {3, 1, 1}), test::box({1.1, -1.2, 0.2}, {1.9, 2.1, 0.8})});
}

TEST(Medial, WarnsInOneLineOfAMeshThatCutsItselfAndNamesTheWayOut) {
  const Workplace here;
  const std::string mesh = here.add("crossed.obj", crossed_boxes()), out = (here / "out").string();
  const std::vector<std::string> arguments{"medial", mesh, "-o", out, "--samples", "600", "--no-views", "--quiet"};
  const Finished run = here.run(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  EXPECT_NE(run.err.find("cut or touch each other"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("--wrap"), std::string::npos) << run.err;
  EXPECT_TRUE(json::parse(here.files("out").at("crossed-medial.json")).contains("warning"));

  std::vector<std::string> wrapped = arguments;
  wrapped.push_back("--wrap");
  const Finished skin = here.run(wrapped);
  EXPECT_EQ(skin.exit_code, 0) << skin.err;
  EXPECT_EQ(skin.err, "");
  const json report = json::parse(here.files("out").at("crossed-medial.json"));
  EXPECT_FALSE(report.contains("warning"));
  EXPECT_EQ(report["topology"], report["topology_of_solid"]);
}

TEST(Medial, RefusesBadOptionsInOneLine) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  for (const std::vector<std::string>& options : {std::vector<std::string>{"--sweep", "nothing=1"},
                                                  {"--sweep", "samples=5"},
                                                  {"--sweep", "samples"},
                                                  {"--samples", "100", "--edge-samples", "101"},
                                                  {"--axis", (here / "none.ma").string()}}) {
    std::vector<std::string> arguments{"medial", mesh, "-o", out};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << options[1];
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--prune-angle", "200"}).exit_code, 2);
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--samples", "20.5"}).exit_code, 2);
}

}  // namespace
}  // namespace orchard
