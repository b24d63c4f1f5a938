#include <gtest/gtest.h>

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

TriangleMesh plate() { return test::box(Point(0, 0, 0), Point(4, 4, 0.5)); }

std::vector<std::string> measure(const std::string& mesh, const std::filesystem::path& folder,
                                 const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"thickness", mesh, "-o", folder.string(), "--samples", "1000"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(ThicknessCommand, SaysWhereAPlateIsTooThinAndExitsWithFourIfAsked) {
  const Workplace here;
  const std::string mesh = here.add("plate.obj", plate());
  const Finished thin = here.run(measure(mesh, here / "out", {"--fail-below", "0.6", "--json"}));
  EXPECT_EQ(thin.exit_code, 4) << thin.err;
  const json report = json::parse(thin.out);
  EXPECT_TRUE(report["too_thin"].get<bool>());
  EXPECT_EQ(report["below"]["regions"].size(), 2u);  // the upper and the lower side
  EXPECT_NEAR(report["below"]["regions"][0]["min_thickness"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(report["thickness"]["median"].get<double>(), 0.5, 1e-9);
  const Finished thick = here.run(measure(mesh, here / "out", {"--fail-below", "0.5", "--json"}));
  EXPECT_EQ(thick.exit_code, 0) << thick.err;
  const Finished told = here.run(measure(mesh, here / "out", {"--below", "0.6", "--unit", "mm"}));
  EXPECT_EQ(told.exit_code, 0) << told.err;
  EXPECT_NE(told.out.find("thinner than 0.6 mm"), std::string::npos) << told.out;
}

TEST(ThicknessCommand, WritesArraysThatAreTheReportsNumbers) {
  const Workplace here;
  const Finished run = here.run(measure(here.add("plate.obj", plate()), here / "out", {"--unit", "mm", "--quiet"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto files = here.files("out");
  for (const char* name : {"plate-thickness.ply", "plate-thickness.csv", "plate-thickness.svg", "plate-thickness.json"})
    EXPECT_EQ(files.count(name), 1u) << name;
#ifdef ORCHARD_HAS_VIZ
  EXPECT_NE(files.at("plate-thickness.vtp").find("ball_diameter"), std::string::npos);
#endif
  const PlyTables tables(here / "out/plate-thickness.ply");
  const PlyTables::Table* faces = tables.find("face");
  ASSERT_NE(faces, nullptr);
  double largest = 0;
  for (const double thickness : faces->find("thickness")->numbers) {
    if (thickness > largest) largest = thickness;
  }
  EXPECT_NEAR(largest, json::parse(files.at("plate-thickness.json"))["thickness"]["max"].get<double>(), 1e-12);
  EXPECT_EQ(tables.find("vertex")->find("ball_diameter")->numbers.size(), tables.find("vertex")->rows());
  EXPECT_NE(files.at("plate-thickness.ply").find("comment unit mm\n"), std::string::npos);
  EXPECT_NE(files.at("plate-thickness.ply").find("comment orchard {"), std::string::npos);
  EXPECT_NE(files.at("plate-thickness.csv").find("\n# orchard {"), std::string::npos);
  EXPECT_EQ(read_mesh(here / "out/plate-thickness.ply").triangles.size(), faces->rows());
}

TEST(ThicknessCommand, RefusesWhatItCannotMeasureInOneLine) {
  const Workplace here;
  const std::string mesh = here.add("plate.obj", plate());
  const std::vector<std::vector<std::string>> wrong{{"--facing", "200"},
                                                    {"--facing", "nan"},
                                                    {"--smooth", "0"},
                                                    {"--unit", "a b"},
                                                    {"--below", "-1"},
                                                    {"--bins", "0"},
                                                    {"--definition", "shortest"},
                                                    {"--below", "1", "--fail-below", "1"}};
  for (const auto& more : wrong) {
    const Finished run = here.run(measure(mesh, here / "out", more));
    EXPECT_EQ(run.exit_code, 2) << more[0];
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
  const Finished missing = here.run(measure((here / "none.obj").string(), here / "out", {}));
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_TRUE(here.files("out").empty());
}

}  // namespace
}  // namespace orchard
