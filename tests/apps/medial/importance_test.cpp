// What --importance and --prune-curve add to an axis.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

std::vector<std::string> medial(const Workplace& here, const std::vector<std::string>& more) {
  std::vector<std::string> words{"medial",    here.add("plate.obj", test::box({0, 0, 0}, {1, 4, 4})),
                                 "-o",        (here / "out").string(),
                                 "--samples", "400",
                                 "--no-views"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<std::vector<std::string>> table(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    std::vector<std::string>& row = rows.emplace_back();
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) row.push_back(word);
  }
  return rows;
}

TEST(ImportanceOption, AddsAColumnForEachMeasureToTheBalls) {
  const Workplace here;
  const Finished run = here.run(medial(here, {"--export", "csv,npz", "--importance", "lambda,scale", "--quiet"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto files = here.files("out");
  const auto rows = table(files.at("plate-axis-balls.csv"));
  ASSERT_GT(rows.size(), 10u);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"x", "y", "z", "radius", "structure", "structure_kind", "lambda",
                                               "scale_ratio"}));
  for (std::size_t i = 1; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), rows[0].size());
    EXPECT_LE(std::stod(rows[i][6]), std::stod(rows[i][3]) * (1 + 1e-9)) << "contacts lie on the ball";
    const double scale = std::stod(rows[i][7]);
    EXPECT_TRUE(std::isnan(scale) || scale >= 1);
  }
  EXPECT_NE(files.at("plate-axis.npz").find("scale_ratio.npy"), std::string::npos);
}

TEST(PruneCurve, FallsInSizeAndRisesInErrorWithTheValue) {
  const Workplace here;
  const Finished run = here.run(medial(here, {"--prune-curve", "lambda", "--quality-samples", "1000", "--json"}));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json curve = json::parse(run.out)["prune_curve"];
  EXPECT_EQ(curve["measure"], "lambda");
  const json& rows = curve["rows"];
  ASSERT_GT(rows.size(), 3u);
  EXPECT_EQ(rows.front()["area"], 1.0);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_GT(rows[i]["value"], rows[i - 1]["value"]);
    EXPECT_LE(rows[i]["area"], rows[i - 1]["area"]);
  }
  EXPECT_LT(rows.back()["area"], 0.7);
  EXPECT_GT(rows.back()["coverage_max"], rows.front()["coverage_max"]);
  const auto files = here.files("out");
  EXPECT_EQ(table(files.at("plate-prune-lambda.csv")).size(), rows.size() + 1);
  EXPECT_NE(files.at("plate-prune-lambda.svg").find("</svg>"), std::string::npos);
}

TEST(PruneCurve, IsOfTheAxisThatPruneMakes) {
  const Workplace here;
  const Finished curve = here.run(medial(here, {"--prune-curve", "erosion", "--quality-samples", "1000", "--json"}));
  ASSERT_EQ(curve.exit_code, 0) << curve.err;
  const json row = json::parse(curve.out)["prune_curve"]["rows"][3];
  const std::string value = "erosion=" + std::to_string(row["value"].get<double>());
  const Finished pruned = here.run(medial(here, {"--prune", value, "--json", "--force"}));
  ASSERT_EQ(pruned.exit_code, 0) << pruned.err;
  const json report = json::parse(pruned.out);
  EXPECT_NEAR(report["build"]["vertices"].get<double>(), row["vertices"].get<double>(), 3) << value;
  EXPECT_GT(report["build"]["vertices_before_pruning"], report["build"]["vertices"]);
  EXPECT_EQ(report["topology"], report["topology_of_solid"]);
}

TEST(ImportanceOption, IsRefusedWhereItHasNoEffect) {
  const Workplace here;
  const std::string axis = here.add("axis.ma", "1 0 0\nv 0.5 2 2 0.5\n");
  for (const auto& [more, said] : std::vector<std::pair<std::vector<std::string>, std::string>>{
           {{"--importance", "lambda", "--axis", axis}, "--importance has no effect with --axis"},
           {{"--prune-curve", "lambda", "--sweep", "samples=300,400"}, "--prune-curve has no effect with --sweep"},
           {{"--importance", "size"}, "--importance"},
           {{"--prune-curve", "size"}, "--prune-curve"}}) {
    const Finished run = here.run(medial(here, more));
    EXPECT_EQ(run.exit_code, 2) << said;
    EXPECT_NE(run.err.find(said), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace orchard
