// The pages of --report and of `orchard report`.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

void expect_self_contained(const std::string& page) {
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  for (const char* outside : {"src=\"http", "src=\"/", "href=\"http", "<script", "<link", "@import", "url("})
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
}

// A box with its tree, made once.
struct Model {
  Workplace here;
  std::string mesh = here.add("box.obj", test::box({0, 0, 0}, {2, 1, 1})), out = (here / "out").string();
  std::string tree = out + "/box.orchard";
  Model() {
    const Finished run = here.run(test::quick_build(mesh, out, {"--report"}));
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
};

TEST(ReportPage, IsWrittenByEveryCommandThatMeasures) {
  const Model model;
  struct Case {
    std::vector<std::string> words;
    const char* page;
    const char* word;  // of explanation, from the schema
  };
  const std::string set = model.out + "/box-set.txt";
  for (const Case& one :
       {Case{{"medial", model.mesh, "--samples", "200", "--quality-samples", "300", "--no-views"},
             "box-medial-report.html",
             "Summed length of edges with one triangle"},
        {{"medial", model.mesh, "--raw", "--sweep", "samples=150,250", "--quality-samples", "300"},
         "box-medial-sweep-report.html",
         "Points that gap repair added"},
        {{"compare", model.mesh, model.tree}, "box-compare-report.html", "Mean inaccuracy of its spheres"},
        {{"profile", model.tree, "--flights", "3"}, "box-profile-report.html", "Poses that reached it"},
        {{"simulate", "pile", "--frames", "5", "--bodies", "3", "--no-views"},
         "pile-simulate-report.html",
         "Times that the motion of a body was asked for"},
        {{"spheres", model.mesh, "-n", "4", "--effort", "low", "--no-views", "--error-curve", "2,3"},
         "box-spheres-report.html",
         "Largest protrusion"},
        {{"audit", set, model.mesh}, "box-audit-report.html", "cuRobo defines it"},
        {{"thickness", model.mesh, "--samples", "100", "--no-views"}, "box-thickness-report.html", "Median by area"},
        {{"sample", model.mesh, "--samples", "100", "--no-views"},
         "box-sample-report.html",
         "Between which points they were relaxed"},
        {{"voronoi", model.mesh, "--samples", "100"}, "box-voronoi-report.html", "Whether a mesh was sampled"},
        {{"skeleton", model.mesh, "--samples", "200", "--no-views"}, "box-skeleton-report.html", "Ends of curves"},
        {{"segment", model.mesh, "--samples", "200", "--no-views"},
         "box-segment-report.html",
         "What divides the surface"},
        {{"offset", model.mesh, "--distance", "0.1", "--tolerance", "3", "--no-views"},
         "box-offset-report.html",
         "Edge length of the cells"}}) {
    std::vector<std::string> words = one.words;
    words.insert(words.end(), {"-o", model.out, "--report", "--quiet"});
    const Finished run = model.here.run(words);
    ASSERT_TRUE(run.exit_code == 0 || run.exit_code == 5) << words[0] << run.err;
    const auto files = model.here.files("out");
    ASSERT_TRUE(files.contains(one.page)) << one.page;
    const std::string& page = files.at(one.page);
    expect_self_contained(page);
    EXPECT_NE(page.find(one.word), std::string::npos) << one.page;
    EXPECT_NE(page.find("orchard " + words[0]), std::string::npos) << "the command is missing";
  }
  EXPECT_FALSE(model.here.files("out").contains("box-set.png")) << "the picture was not asked for by itself";
}

TEST(ReportPage, NeedsAFolder) {
  const Model model;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"compare", model.mesh, model.tree, "--report"},
                                                {"profile", model.tree, "--report"},
                                                {"simulate", "pile", "--report"}}) {
    const Finished run = model.here.run(words);
    EXPECT_EQ(run.exit_code, 2) << words[0];
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
}

TEST(ReportCommand, PutsRunsOfAnyCommandsOnOnePageAndSaysWhatDiffers) {
  const Model model;
  for (const char* folder : {"a", "b"}) {
    const Finished run = model.here.run({"thickness", model.mesh, "-o", (model.here / folder).string(), "--samples",
                                         *folder == 'a' ? "100" : "200", "--no-views", "--quiet"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const std::string page = (model.here / "pages.html").string();
  const Finished run =
      model.here.run({"report", (model.here / "a/box-thickness.json").string(),
                      (model.here / "b/box-thickness.json").string(), model.out + "/box.json", "-o", page});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::string text = model.here.files(".").at("pages.html");
  expect_self_contained(text);
  for (const char* part : {"<h1>3 runs of orchard</h1>", "id=\"run-1\"", "id=\"run-3\"", "1. box: thickness",
                           "3. box: build", "Runs of thickness beside each other", "<td>triangles</td>"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  const std::size_t compared = text.find("Runs of thickness"), end = text.find("id=\"run-1\"");
  EXPECT_EQ(text.substr(compared, end - compared).find("<td>definition</td>"), std::string::npos)
      << "it is the same in both";
}

TEST(ReportCommand, RefusesWhatIsNoReport) {
  const Model model;
  const std::string page = (model.here / "page.html").string();
  json cut = json::parse(model.here.files("out").at("box.json")), old = cut;
  cut.erase("octree_levels");
  old["provenance"]["schema_version"] = 1;
  for (const auto& [name, text, word] : {std::tuple{"garbage.json", std::string("{\"a\": "), "is no JSON at byte"},
                                         {"other.json", std::string("{\"a\": 1}"), "is no report of orchard"},
                                         {"list.json", std::string("[1, 2]"), "is no report of orchard"},
                                         {"odd.json", std::string("{\"provenance\": 3}"), "is no report of orchard"},
                                         {"cut.json", cut.dump(), "lacks values"},
                                         {"old.json", old.dump(), "version 1 of the keys"}}) {
    const std::string file = model.here.add(name, text);
    const Finished run = model.here.run({"report", model.out + "/box.json", file, "-o", page});
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
  }
  EXPECT_FALSE(std::filesystem::exists(page));
  EXPECT_EQ(model.here.run({"report", model.out + "/box.json", "-o", (model.here / "page.txt").string()}).exit_code, 2);
}

}  // namespace
}  // namespace orchard
