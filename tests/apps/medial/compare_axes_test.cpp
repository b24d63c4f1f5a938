// `orchard compare` of medial axes, and advice that ends.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

// The axis of a box, raw, as that of another system.
struct Axes {
  Workplace here;
  std::string mesh = here.add("l.obj", test::box({0, 0, 0}, {3, 2, 1})), out = (here / "out").string(), theirs, small;
  Axes() {
    const Finished run = here.run({"medial", mesh, "-o", (here / "raw").string(), "--samples", "150", "--raw",
                                   "--vertices", "12", "--no-views", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    theirs = (here / "raw/l.ma").string(), small = (here / "raw/l-simplified.ma").string();
  }
  Finished compare(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"compare", mesh, theirs, small, "--samples", "200", "--quality-samples", "200"};
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  }
};

TEST(CompareAxes, MeasuresEachBesideOrchardsOfTheSameSize) {
  const Axes axes;
  const Finished run = axes.compare({"--vertices", "20", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  ASSERT_EQ(report["axes"].size(), 2u);
  for (const json& axis : report["axes"]) {
    const bool large = axis["file"] == "l.ma";
    EXPECT_EQ(axis["simplified"], large);
    EXPECT_LE(axis["balls"], large ? 20 : 12);
    EXPECT_EQ(large, axis["balls_of_file"] > axis["balls"]);
    const auto& own = report["own_axes"];
    EXPECT_TRUE(std::any_of(own.begin(), own.end(), [&](const json& o) { return o["balls"] <= axis["balls"]; }));
  }
}

TEST(CompareAxes, WritesTablePictureAndPageAndATableOfSeveralModels) {
  const Axes axes;
  const std::string table = (axes.here / "all.csv").string();
  const Finished run = axes.compare({"--vertices", "12", "-o", axes.out, "--csv", table, "--report", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto files = axes.here.files("out");
  for (const char* name : {"l-compare.csv", "l-compare.json", "l-compare-report.html"})
    EXPECT_TRUE(files.contains(name)) << name;
  const std::string first = test::without_provenance(axes.here.files(".").at("all.csv"));
  EXPECT_EQ(first, test::without_provenance(files.at("l-compare.csv")));
  // Another model, before the first by its name; and the first again, whose rows are replaced.
  const std::string other = (axes.here / "k.obj").string();
  std::filesystem::copy_file(axes.mesh, other);
  const Finished second = axes.here.run({"compare", other, axes.small, "--vertices", "12", "--samples", "200",
                                         "--quality-samples", "200", "--csv", table, "--quiet"});
  ASSERT_EQ(second.exit_code, 0) << second.err;
  const std::string both = test::without_provenance(axes.here.files(".").at("all.csv"));
  EXPECT_LT(both.find("\nk,"), both.find("\nl,"));
  ASSERT_EQ(axes.compare({"--vertices", "12", "--csv", table, "--quiet"}).exit_code, 0);
  EXPECT_EQ(test::without_provenance(axes.here.files(".").at("all.csv")), both);
}

TEST(CompareAxes, RefusesWhatDoesNotFitBeforeItWorks) {
  const Axes axes;
  const std::string tree = axes.here.add("t.sph", std::string("1 8\n0 0 0 9 0\n")),
                    table = axes.here.add("t.csv", std::string("a,b\n1,2\n"));
  for (const auto& [words, word] :
       {std::pair{std::vector<std::string>{"compare", axes.mesh, axes.theirs, tree}, "compare them separately"},
        {{"compare", axes.mesh, tree, "--vertices", "20"}, "--vertices has no effect on sphere-trees"},
        {{"compare", axes.mesh, axes.theirs, "--csv", table}, "compare of this version did not write this table"},
        {{"compare", axes.mesh, axes.theirs, "--report"}, "--report"}}) {
    const Finished run = axes.here.run(words);
    EXPECT_EQ(run.exit_code, 2) << word;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  }
}

TEST(Medial, AdviceEndsWhereItWasTried) {
  const Workplace here;
  const std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();
  const auto report = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{
        "medial", mesh, "-o", out, "--report", "--samples", "200", "--quality-samples", "300", "--no-views", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = here.run(words);
    EXPECT_TRUE(run.exit_code == 0 || run.exit_code == 5) << run.err;
    return json::parse(run.out);
  };
  const json first = report({});
  ASSERT_FALSE(first["worst_places"].empty());
  const std::string advice = first["worst_places"][0]["advice"];  // "--linear-error 0.017"
  const std::size_t space = advice.find(' ');
  ASSERT_TRUE(advice.starts_with("--") && space != std::string::npos) << advice;
  const std::string option = advice.substr(0, space), value = advice.substr(space + 1, advice.find(',') - space - 1);
  EXPECT_EQ(first["trials"].size(), 1u);
  EXPECT_EQ(report({option, value})["trials"].size(), 2u);
  const json again = report({});
  EXPECT_EQ(again["trials"].size(), 2u) << "the same options are one run";
  const std::string ended = again["worst_places"][0]["advice"];
  EXPECT_TRUE(ended.starts_with("no more: " + option + " " + value + " was tried")) << ended;
}

}  // namespace
}  // namespace orchard
