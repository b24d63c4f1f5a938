#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

const std::string kCube = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 0 1\n0 1 1\n1 1 1\n";

TEST(Voronoi, ComparesTheAlgorithmsOnAMesh) {
  const Workplace here;
  const Finished run =
      here.run({"voronoi", here.add("l.obj", test::l_shape()), "--compare", "--samples", "500", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_TRUE(report["sampled"].get<bool>());
  ASSERT_EQ(report["algorithms"].size(), 4u);
  const json &bowyer = report["algorithms"][0], &inagaki = report["algorithms"][1],
             &highest_first = report["algorithms"][2], &exact = report["algorithms"][3];
  EXPECT_EQ(bowyer["failures"], 1);
  EXPECT_NE(bowyer["failure"].get<std::string>().find("fails at point"), std::string::npos);
  for (const json* other : {&inagaki, &highest_first, &exact}) {
    EXPECT_EQ((*other)["failures"], 0);
    EXPECT_GT((*other)["vertices"].get<int>(), 1000);
    EXPECT_GT((*other)["vertices_at_infinity"].get<int>(), 10);
  }
  EXPECT_GT(inagaki["inaccuracy"]["mean"].get<double>(), 1e-3);
  EXPECT_LT(highest_first["inaccuracy"]["mean"].get<double>(), 1e-15);
  EXPECT_LT(exact["inaccuracy"]["mean"].get<double>(), 1e-15);
  const json& insertions = highest_first["insertions"];
  EXPECT_EQ(insertions["certified"].get<int>() + insertions["settled"].get<int>() + insertions["exact"].get<int>() +
                insertions["constrained"].get<int>() + 4,
            report["points"].get<int>());
  EXPECT_LE(highest_first["certified_intrusion_over_radius"].get<double>(), 1e-9);
}

TEST(Voronoi, RefusesSizesThatItCannotWorkWithAndSaysWhichPointItIs) {
  const Workplace here;
  const auto cube = [](const std::string& exponent) {
    std::string rows;
    for (const char c : kCube) rows += c == '1' ? c + exponent : std::string(1, c);
    return rows;
  };
  for (const char* good : {"e99", "e-99", "e30", "e-30"}) {
    const Finished run = here.run({"voronoi", here.add("good.xyz", cube(good)), "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_GT(json::parse(run.out)["algorithms"][0]["vertices"].get<int>(), 10) << good;
  }
  const Finished large = here.run({"voronoi", here.add("large.xyz", cube("e120")), "--json"});
  EXPECT_EQ(large.exit_code, 2);
  EXPECT_NE(large.err.find("large.xyz: point 1 has a coordinate beyond 1e100"), std::string::npos) << large.err;
  const Finished small = here.run({"voronoi", here.add("small.xyz", cube("e-120")), "--json"});
  EXPECT_EQ(small.exit_code, 2);
  EXPECT_NE(small.err.find("small.xyz: the points are less than 1e-100 apart"), std::string::npos) << small.err;
}

TEST(Voronoi, PrintsATable) {
  const Workplace here;
  const Finished run = here.run({"voronoi", here.add("cube.xyz", kCube), "--compare"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* part : {"cube.xyz: 8 points", "algorithm", "failures", "seconds", "\nbowyer", "\ninagaki",
                           "\nhighest-first", "\nexact"})
    EXPECT_NE(run.out.find(part), std::string::npos) << part << " in\n" << run.out;
}

TEST(Voronoi, TakesPointsInEveryFormat) {
  const Workplace here;
  std::string obj, rows;
  for (std::size_t at = 0, next; (next = kCube.find('\n', at)) != std::string::npos; at = next + 1) {
    obj += "v " + kCube.substr(at, next - at + 1);
    rows += kCube.substr(at, next - at + 1);
  }
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n" +
      rows;
  for (const auto& file : {here.add("a.xyz", kCube), here.add("b.obj", obj), here.add("c.ply", ply)}) {
    const Finished run = here.run({"voronoi", file, "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const json report = json::parse(run.out);
    EXPECT_EQ(report["points"], 8);
    EXPECT_FALSE(report["sampled"].get<bool>());
    EXPECT_EQ(report["algorithms"][0]["algorithm"], "highest-first");
    EXPECT_GE(report["algorithms"][0]["vertices_at_infinity"].get<int>(), 12);
  }
}

TEST(Voronoi, SaysThatFlatPointsHaveNoVertices) {
  const Workplace here;
  for (const auto& [text, words] : {std::pair{"1 2 3\n1 2 3\n", "are one"},
                                    {"0 0 0\n1 1 1\n2 2 2\n", "lie on a line"},
                                    {"0 0 0\n1 0 0\n0 1 0\n1 1 0\n", "lie in a plane"}}) {
    const Finished run = here.run({"voronoi", here.add("flat.xyz", text)});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
  }
}

TEST(Voronoi, FailsWhereTheChosenAlgorithmDoes) {
  const Workplace here;
  const Finished run =
      here.run({"voronoi", here.add("l.obj", test::l_shape()), "--samples", "500", "--algorithm", "bowyer"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
}

TEST(Voronoi, WritesTheSameFilesOnAnyNumberOfThreads) {
  const Workplace here;
  const std::string mesh = here.add("torus.obj", test::torus(20, 10));
  const auto files = [&](const std::string& threads) {
    std::vector<std::string> arguments{"voronoi", mesh,        "-o",   (here / "out").string(), "--samples", "300",
                                       "--quiet", "--threads", threads};
#ifdef ORCHARD_HAS_VIZ
    arguments.insert(arguments.end(), {"--cells", "0,5,7"});
#endif
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out + run.err, "");
    auto written = here.files("out");
    written.erase("torus-voronoi.json");  // holds times
    return written;
  };
  const auto one = files("1");
  EXPECT_TRUE(one.contains("torus-voronoi.xyz"));
  EXPECT_EQ(one, files("3"));
}

TEST(Voronoi, RefusesBadInputInOneLine) {
  const Workplace here;
  const std::string cube = here.add("cube.xyz", kCube);
  const std::string out = (here / "out").string();
  const std::vector<std::vector<std::string>> bad{{"voronoi", (here / "missing.xyz").string()},
                                                  {"voronoi", here.add("two.xyz", std::string("1 2\n"))},
                                                  {"voronoi", here.add("cloud.pts", kCube)},
                                                  {"voronoi", cube, "-o", out, "--box", "1", "1", "1", "0", "0", "0"}};
  for (const auto& arguments : bad) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments[1];
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
  EXPECT_EQ(here.run({"voronoi", cube, "--algorithm", "fortune"}).exit_code, 2);
  EXPECT_TRUE(here.files("out").empty());
}

}  // namespace
}  // namespace orchard
