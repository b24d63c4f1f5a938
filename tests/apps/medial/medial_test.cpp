// One command with all its flags, each run on the same few models: hence more than 300 lines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

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
  EXPECT_EQ(report["quality"]["topology_right"], 1);
  EXPECT_LT(report["quality"]["coverage_mean"].get<double>(), 1);
  EXPECT_TRUE(report["quality"]["stability_max"].is_number());
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
  const json refined = run("refined", {"--open-rounds", "0"}), raw = run("raw", {"--raw"}),
             no = run("no", {"--refine", "no"});
  EXPECT_TRUE(raw["build"]["refinement"].is_null());
  EXPECT_EQ(test::without_provenance(here.files("raw").at("l.ma")),
            test::without_provenance(here.files("no").at("l.ma")));
  EXPECT_EQ(refined["build"]["refinement"]["vertices_before"], raw["build"]["vertices"]);
  EXPECT_GT(refined["build"]["refinement"]["vertices_on_sharp_edges"], 50);
  const auto max = [](const json& report, const char* metric) { return report["quality"][metric].get<double>(); };
  EXPECT_LT(max(refined, "radius_error_max"), 1e-7);
  EXPECT_LT(max(refined, "protrusion_max"), 0.2 * max(raw, "protrusion_max"));
  EXPECT_LT(max(refined, "coverage_max"), max(raw, "coverage_max"));
  EXPECT_LT(max(refined, "hausdorff_mean"), max(raw, "hausdorff_mean"));
  EXPECT_EQ(refined["quality"]["topology_right"], 1);
  EXPECT_EQ(here.run({"medial", mesh, "-o", (here / "x").string(), "--border-loss", "-1"}).exit_code, 2);
}

// Between two boxes that are near each other, the axis outside is the plane in the middle.
TEST(Medial, BuildsTheAxisOfTheSpaceAroundTheSolid) {
  const Workplace here;
  const std::string mesh = here.add("boxes.obj", test::two_boxes(0.25)), out = (here / "out").string();
  const Finished run = here.run({"medial", mesh, "-o", out, "--side", "outside", "--samples", "600", "--json",
                                 "--no-views", "--report", "--quality-samples", "500"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["quality"]["topology_right"], 1);
  EXPECT_EQ(report["quality"]["cavities"], 2);  // each box is one of the space around it
  EXPECT_LT(report["quality"]["radius_error_max"].get<double>(), 0.1);
  const Finished judged = here.run({"medial", mesh, "-o", (here / "other").string(), "--side", "outside", "--axis",
                                    out + "/boxes.ma", "--quality-samples", "500", "--json"});
  ASSERT_EQ(judged.exit_code, 0) << judged.err;
  EXPECT_EQ(json::parse(judged.out)["quality"]["coverage_max"], report["quality"]["coverage_max"]);
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--side", "outside", "--sweep", "samples=100,200"},
        {"--side", "outside", "--open-rounds", "2"},
        {"--side", "outside", "--outside-radius", "1"},
        {"--outside-radius", "3"},
        {"--side", "inside", "--outside-radius", "3"},
        {"--side", "beside"}}) {
    std::vector<std::string> all{"medial", mesh, "-o", (here / "x").string()};
    all.insert(all.end(), words.begin(), words.end());
    const Finished refused = here.run(all);
    EXPECT_EQ(refused.exit_code, 2) << words.back();
    EXPECT_FALSE(refused.err.empty());
  }
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
  for (const char* needs_a_build : {"stability_max", "stability_99", "stability_mean"}) {
    EXPECT_TRUE(first[needs_a_build].is_number());
    EXPECT_TRUE(second[needs_a_build].is_null());
    first.erase(needs_a_build);
    second.erase(needs_a_build);
  }
  EXPECT_EQ(first, second);
  EXPECT_TRUE(here.files("other").contains("l-quality.json"));
}

// Arguments for the report of a small solid.
std::vector<std::string> small_report(const std::string& mesh, const std::string& folder,
                                      const std::vector<std::string>& more) {
  std::vector<std::string> words{
      "medial", mesh, "-o", folder, "--report", "--samples", "400", "--quality-samples", "1000", "--no-views"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST(Medial, MeasuresOtherAxesBesideItsOwnWithTheSameInstrument) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape());
  ASSERT_EQ(
      here.run({"medial", mesh, "-o", (here / "raw").string(), "--raw", "--samples", "300", "--no-views"}).exit_code,
      0);
  const std::string raw = (here / "raw/l.ma").string();
  // One ball and nothing else: far from the solid's axis, and no cover of its surface.
  const std::string ball = here.add("ball.ma", std::string("1 0 0\nv 0.5 0.5 0.25 0.2\n"));
  const Finished run = here.run(small_report(mesh, (here / "out").string(), {"--beside", raw, "--beside", ball}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(here.files("out").at("l-medial.json"));
  ASSERT_EQ(report["beside"].size(), 2u);
  EXPECT_EQ(report["beside"][1]["vertices"], 1);
  const Finished alone =
      here.run({"medial", mesh, "-o", (here / "alone").string(), "--axis", raw, "--quality-samples", "1000", "--json"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  json beside = report["beside"][0]["quality"], judged = json::parse(alone.out)["quality"];
  EXPECT_GT(beside["distance_max"].get<double>(), beside["distance_mean"].get<double>());
  EXPECT_GT(report["beside"][1]["quality"]["distance_max"], beside["distance_max"]);
  for (json* values : {&beside, &judged}) {
    values->erase("distance_max");
    values->erase("distance_mean");
  }
  EXPECT_EQ(beside, judged);
  EXPECT_TRUE(report["quality"]["distance_max"].is_null());  // from itself
  EXPECT_TRUE(report["quality"]["stability_max"].is_number());
  EXPECT_TRUE(beside["stability_max"].is_null());  // would need the system that made it
  for (const json& values : {report["quality"], beside})
    EXPECT_EQ(values["economy_spheres"].is_number(), values["economy_uncovered"].get<double>() <= 0.01);
  EXPECT_TRUE(report["beside"][1]["quality"]["economy_spheres"].is_null());  // leaves most of the surface

  // The printed table has a column for each.
  std::map<std::string, std::string> rows;
  std::istringstream out(run.out);
  for (std::string line; std::getline(out, line);) rows[line.substr(0, std::min<std::size_t>(line.size(), 32))] = line;
  const auto row = [&](const std::string& title) {
    std::string padded = "  " + title;
    padded.resize(32, ' ');
    return rows[padded];
  };
  const auto times = [](const std::string& text, const std::string& word) {
    int count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
  };
  EXPECT_EQ(times(row("stability, max"), "not defined"), 2) << run.out;
  EXPECT_EQ(times(row("distance from this axis, max"), "not defined"), 1) << run.out;
  EXPECT_EQ(times(row("coverage error, max"), "not defined"), 0) << run.out;
  EXPECT_NE(run.out.find("ball.ma"), std::string::npos);
}

TEST(Medial, NamesTheWorstPlacesAlikeInTheReportAndTheJson) {
  const Workplace here;
  const Finished run = here.run(small_report(here.add("l.obj", test::l_shape()), (here / "out").string(), {"--raw"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(here.files("out").at("l-medial.json"));
  const json& places = report["worst_places"];
  ASSERT_GE(places.size(), 6u);
  EXPECT_DOUBLE_EQ(places[0]["value"], report["quality"]["protrusion_max"]);
  int coverages = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const json& place = places[i];
    EXPECT_EQ(place["number"], i + 1);
    if (i > 0 && place["measure"] == places[i - 1]["measure"]) {
      EXPECT_LE(place["value"], places[i - 1]["value"]);
    }
    if (place["measure"] == "coverage" && ++coverages == 1) {
      EXPECT_DOUBLE_EQ(place["value"], report["quality"]["coverage_max"]);
    }
    EXPECT_NE(place["advice"].get<std::string>().find("--"), std::string::npos);
    // The printed line has the same number, value and place.
    char line[200];
    std::snprintf(line, sizeof line, "  %10zu  %-11s %18.5f  %.6g %.6g %.6g: ", i + 1,
                  place["measure"].get<std::string>().c_str(), place["value"].get<double>(),
                  place["position"][0].get<double>(), place["position"][1].get<double>(),
                  place["position"][2].get<double>());
    EXPECT_NE(run.out.find(line + place["advice"].get<std::string>() + "\n"), std::string::npos) << line << run.out;
  }
  EXPECT_GT(coverages, 0);
}

TEST(Medial, RefusesAxesBesideThatCannotBeReadBeforeItBuilds) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const std::string bad = here.add("bad.ma", std::string("1 0 0\nv 0 0 zero 1\n"));
  // With so many samples building would take minutes.
  const Finished unreadable =
      here.run({"medial", mesh, "-o", out, "--samples", "3000000", "--report", "--beside", bad});
  EXPECT_EQ(unreadable.exit_code, 2);
  EXPECT_TRUE(test::is_one_line_error(unreadable.err)) << unreadable.err;
  EXPECT_NE(unreadable.err.find("line 2"), std::string::npos) << unreadable.err;
  const Finished missing = here.run({"medial", mesh, "-o", out, "--report", "--beside", (here / "no.ma").string()});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(missing.err.find("no.ma"), std::string::npos) << missing.err;
  const std::string ball = here.add("ball.ma", std::string("1 0 0\nv 0.5 0.5 0.25 0.2\n"));
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--beside", ball}).exit_code, 2);
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--sweep", "samples=200,300", "--beside", ball}).exit_code, 2);
  EXPECT_EQ(
      here.run({"medial", mesh, "-o", out, "--axis", ball, "--beside", ball, "--quality-samples", "500"}).exit_code, 0);
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
  for (const char* column : {",level_1_mean,", ",level_1_max,", ",level_2_mean,", ",level_2_outside"})
    EXPECT_NE(here.files("out").at("l-sweep.csv").find(column), std::string::npos) << column;
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--tree", "merging"}).exit_code, 2);
}

TEST(Medial, EveryTuningFlagIsOnThePageOfTuning) {
  const Workplace here;
  const Finished help = here.run({"medial", "--help"});
  ASSERT_EQ(help.exit_code, 0);
  std::ifstream file(ORCHARD_TUNING_PAGE);
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  std::istringstream tuning(help.out.substr(help.out.find("Tuning:")));
  int flags = 0;
  for (std::string line; std::getline(tuning, line) && !line.empty();) {
    if (!line.starts_with("  --")) continue;
    ++flags;
    const std::string word = line.substr(2, line.find(' ', 2) - 2);
    // "`--samples`", or with a measure as in "`--prune angle=A`".
    const bool is_there =
        page.find("| `" + word + "`") != std::string::npos || page.find("| `" + word + " ") != std::string::npos;
    EXPECT_TRUE(is_there) << word;
  }
  EXPECT_GT(flags, 15);
}

TEST(Medial, SweepsShowTheirBestRowsFirst) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const auto sweep = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "medial", mesh, "-o", out, "--raw", "--quality-samples", "500", "--sweep", "samples=200,800,400"};
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  };
  const Finished standard = sweep({"--json"});
  ASSERT_EQ(standard.exit_code, 0) << standard.err;
  json report = json::parse(standard.out);
  EXPECT_EQ(report["best_by"], "hausdorff_max");
  for (std::size_t i = 1; i < 3; ++i)
    EXPECT_LE(report["runs"][i - 1]["hausdorff_max"], report["runs"][i]["hausdorff_max"]);
  report = json::parse(sweep({"--json", "--sort-by", "balls"}).out);
  EXPECT_EQ(report["best_by"], "balls");
  EXPECT_EQ(report["runs"][0]["samples"], "200");
  EXPECT_EQ(report["runs"][2]["samples"], "800");
  // The file keeps the order of the sweep.
  const std::string csv = here.files("out").at("l-sweep.csv");
  EXPECT_LT(csv.find("\n800,"), csv.find("\n400,"));
  const Finished printed = sweep({"--sort-by", "balls"});
  EXPECT_NE(printed.out.find("best first, by balls"), std::string::npos) << printed.out;
  for (const char* measure : {"loops", "nothing"}) {
    const Finished refused = sweep({"--sort-by", measure});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_TRUE(test::is_one_line_error(refused.err)) << refused.err;
  }
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--sort-by", "balls"}).exit_code, 2);
}

#ifdef ORCHARD_HAS_VIZ
TEST(Medial, DrawsWhereItIsWorstWithTheReport) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const Finished run = here.run({"medial", mesh, "-o", out, "--samples", "150", "--report", "--quality-samples", "200",
                                 "--picture", "--up", "z", "--quiet"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const auto files = here.files("out");
  EXPECT_TRUE(files.contains("l-medial.png") || run.err.find("no picture was made") != std::string::npos) << run.err;
  for (const char* array : {"\"radius_error\"", "\"centredness\"", "\"protrusion\"", "\"contact_angle\""}) {
    EXPECT_NE(files.at("l-medial.vtu").find(array), std::string::npos) << array;
    EXPECT_NE(files.at("l-medial-faces.vtp").find(array), std::string::npos) << array;  // vertices have it
  }
  for (const char* name : {"l-medial-points.vtp", "l-medial-thickness.vtp"})
    EXPECT_NE(files.at(name).find("\"coverage\""), std::string::npos) << name;
  EXPECT_NE(files.at("l-medial-points.vtp").find("\"repair_pass\""), std::string::npos);
  EXPECT_NE(files.at("l-medial-worst.vtp").find("\"number\""), std::string::npos);
  EXPECT_NE(files.at("l-medial.vtm").find("worst places"), std::string::npos);
  for (const char* part : {"/l-medial.vtu", "/l-medial-mesh.vtp", "/l-medial-structure.vtp", "/l-medial-worst.vtp"})
    EXPECT_NE(files.at("l-medial.pvsm").find(part), std::string::npos) << part;
  EXPECT_NE(files.at("l-medial-view.py").find("BALLS, LIGHT_BALLS = "), std::string::npos);
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--picture"}).exit_code, 2);
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--sweep", "samples=200,300", "--picture"}).exit_code, 2);
}

TEST(Medial, ThinsTheBallsOfAFileForSpheresAndSaysSo) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const Finished run = here.run({"medial", mesh, "-o", out, "--samples", "150", "--light", "50"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto files = here.files("out");
  ASSERT_TRUE(files.contains("l-medial-light.vtp"));
  const std::size_t said = run.out.find(" balls, the largest of each region (--light)");
  ASSERT_NE(said, std::string::npos) << run.out;
  const std::string points = "NumberOfPoints=\"";
  const auto count = [&](const std::string& name) {
    return std::stoul(files.at(name).substr(files.at(name).find(points) + points.size()));
  };
  EXPECT_LE(count("l-medial-light.vtp"), 50u);
  EXPECT_GE(count("l-medial-light.vtp"), 15u);
  EXPECT_NE(files.at("l-medial-view.py")
                .find("BALLS, LIGHT_BALLS = " + std::to_string(count("l-medial-vertices.vtp")) + ", " +
                      std::to_string(count("l-medial-light.vtp")) + "\n"),
            std::string::npos);
  const std::string whole = (here / "whole").string();
  const Finished all = here.run({"medial", mesh, "-o", whole, "--samples", "150", "--light", "0", "--quiet"});
  EXPECT_EQ(all.exit_code, 0) << all.err;
  EXPECT_FALSE(here.files("whole").contains("l-medial-light.vtp"));
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--light", "10", "--no-views"}).exit_code, 2);
}

TEST(Medial, DrawsTheAxesBesideItInItsPicture) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const std::string other = here.add("other.ma", std::string("2 1 0\nv .4 .4 .4 .3\nv .6 .4 .4 .3\ne 0 1\n"));
  const auto height = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"medial",    mesh,        "-o",         out,
                                 "--samples", "150",       "--report",   "--quality-samples",
                                 "200",       "--picture", "--no-views", "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    const Finished run = here.run(all);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto files = here.files("out");
    if (!files.contains("l-medial.png")) return 0;
    const std::string& png = files.at("l-medial.png");
    return static_cast<unsigned char>(png[22]) << 8 | static_cast<unsigned char>(png[23]);
  };
  const int alone = height({});
  if (alone == 0) GTEST_SKIP() << "nothing can be drawn here";
  EXPECT_EQ(height({"--beside", other}), 2 * alone) << "a row for each axis";
}
#endif

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

TEST(Medial, SweepsAllCombinationsIntoOneTableAndPlotsWhatTheyTrade) {
  const Workplace here;
  const Finished run =
      here.run({"medial", here.add("l.obj", test::l_shape()), "-o", (here / "out").string(), "--sweep",
                "samples=100,200", "--sweep", "prune angle=0,30,60", "--quality-samples", "300", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  const auto files = here.files("out");
  const std::string csv = test::without_provenance(files.at("l-sweep.csv"));
  EXPECT_EQ(lines(csv), 7u);
  EXPECT_EQ(csv.substr(0, 20), "samples,prune angle,");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), ','),
            7 * std::count(csv.begin(), csv.begin() + static_cast<std::ptrdiff_t>(csv.find('\n')), ','));
  const std::string& svg = files.at("l-sweep.svg");
  for (const char* part : {"</svg>", "prune angle 30", "against balls", "against seconds", "largest distance"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
}

TEST(Medial, GivesTheSameBytesOnAnyNumberOfThreads) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(20, 10));
  const auto axis = [&](const char* threads) {
    const Finished run = here.run({"medial", mesh, "-o", (here / "out").string(), "--samples", "400", "--quiet",
                                   "--no-views", "--prune", "angle=20", "--threads", threads});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return here.files("out").at("torus.ma");
  };
  EXPECT_EQ(axis("1"), axis("3"));
}

// Two boxes that cut each other: no gap between their sheets could be mended.
TriangleMesh crossed_boxes() {
  return test::joined({test::box({0, 0, 0}, {3, 1, 1}), test::box({1.1, -1.2, 0.2}, {1.9, 2.1, 0.8})});
}

TEST(Medial, UnitesPartsThatCutEachOther) {
  const Workplace here;
  const std::string mesh = here.add("crossed.obj", crossed_boxes()), out = (here / "out").string();
  const Finished run = here.run({"medial", mesh, "-o", out, "--samples", "600", "--no-views"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NE(run.out.find("were replaced by their union"), std::string::npos) << run.out;
  const json report = json::parse(here.files("out").at("crossed-medial.json"));
  EXPECT_EQ(report["union"]["parts"], 2);
  EXPECT_EQ(report["self_intersections"], 0);
  EXPECT_EQ(report["mesh"]["components"], 1);
  EXPECT_EQ(report["topology"], report["topology_of_solid"]);
}

TEST(Medial, WarnsInOneLineOfAMeshThatCutsItselfAndNamesTheWayOut) {
  const Workplace here;
  const std::string mesh = here.add("crossed.obj", crossed_boxes()), out = (here / "out").string();
  const std::vector<std::string> common{"medial", mesh, "-o", out, "--samples", "600", "--no-views", "--quiet"};
  std::vector<std::string> arguments = common;
  arguments.insert(arguments.end(), {"--union", "no"});
  const Finished run = here.run(arguments);
  EXPECT_EQ(run.exit_code, 5) << run.err;
  EXPECT_NE(run.err.find("promise not kept"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("cut or touch each other"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("--wrap"), std::string::npos) << run.err;
  const json broken = json::parse(here.files("out").at("crossed-medial.json"));
  EXPECT_TRUE(broken.contains("warning"));
  EXPECT_FALSE(broken["promise"]["kept"].get<bool>());
  EXPECT_FALSE(broken["promise"]["broken"].empty());
  EXPECT_NE(here.files("out").at("crossed.ma").find("# promise not kept: "), std::string::npos) << "the file is marked";
  std::vector<std::string> accepted = arguments;
  accepted.push_back("--accept");
  const Finished as_it_is = here.run(accepted);
  EXPECT_EQ(as_it_is.exit_code, 0);
  EXPECT_EQ(as_it_is.err, run.err) << "it is said all the same";

  std::vector<std::string> wrapped = common;
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
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--prune", "angle=200"}).exit_code, 2);
  EXPECT_EQ(here.run({"medial", mesh, "-o", out, "--samples", "20.5"}).exit_code, 2);
}

}  // namespace
}  // namespace orchard
