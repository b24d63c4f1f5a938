// `orchard medial --sweep`: options, what is kept, what is not computed again.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

struct Sweep {
  Workplace here;
  std::string mesh = here.add("l.obj", test::l_shape()), out = (here / "out").string();

  Finished run(const std::vector<std::string>& more) const {
    std::vector<std::string> words{"medial", mesh, "-o", out, "--raw", "--quality-samples", "300", "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return here.run(words);
  }
  json report(const std::vector<std::string>& more) const {
    const Finished finished = run(more);
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return finished.exit_code == 0 ? json::parse(finished.out) : json();
  }
};

TEST(MedialSweep, VariesTheNumberOfBallsOfOneAxis) {
  const Sweep sweep;
  const json report = sweep.report({"--samples", "150", "--sweep", "vertices=10,40,20", "--sort-by", "balls"});
  ASSERT_EQ(report["runs"].size(), 3u);
  EXPECT_EQ(report["swept"], json({"vertices"}));
  for (const json& run : report["runs"]) EXPECT_LE(run["balls"], std::stoi(run["vertices"].get<std::string>()));
  EXPECT_EQ(report["runs"][0]["vertices"], "10");
  EXPECT_EQ(report["runs"][2]["vertices"], "40");
  EXPECT_GT(report["runs"][0]["hausdorff_max"], report["runs"][2]["hausdorff_max"]);
  const auto files = sweep.here.files("out");
  const std::string& plot = files.at("l-sweep.svg");
  EXPECT_NE(plot.find("largest distance"), std::string::npos);
  EXPECT_NE(plot.find(">20</text>"), std::string::npos) << "points are labelled by the value";
}

TEST(MedialSweep, LeavesOutWhatIsTheSameInAllRuns) {
  const Sweep sweep;
  sweep.report({"--samples", "150", "--sweep", "vertices=10,20"});
  const std::string csv = sweep.here.files("out").at("l-sweep.csv"), head = csv.substr(0, csv.find('\n'));
  EXPECT_NE(head.find(",balls"), std::string::npos);
  EXPECT_EQ(head.find("topology_right"), std::string::npos) << head;
  EXPECT_EQ(head.find("points_added"), std::string::npos) << head;
}

TEST(MedialSweep, DoesNotComputeAgainWhatItHas) {
  const Sweep sweep;
  const json first = sweep.report({"--sweep", "samples=150,250"});
  EXPECT_EQ(first["runs_taken_over"], 0);
  json again = sweep.report({"--sweep", "samples=150,250"});
  EXPECT_EQ(again["runs_taken_over"], 2);
  EXPECT_EQ(again["runs"], first["runs"]) << "seconds and all";
  // One value more, and another option.
  EXPECT_EQ(sweep.report({"--sweep", "samples=150,350,250"})["runs_taken_over"], 2);
  EXPECT_EQ(sweep.report({"--sweep", "samples=150,250", "--seed", "2"})["runs_taken_over"], 0);
  EXPECT_EQ(sweep.report({"--sweep", "samples=150,250"})["runs_taken_over"], 2) << "the first ones are still there";
  // Another mesh in the file of the same name.
  TriangleMesh other = test::l_shape();
  for (Point& vertex : other.vertices) vertex *= 1.5;
  sweep.here.add("l.obj", other);
  EXPECT_EQ(sweep.report({"--sweep", "samples=150,250"})["runs_taken_over"], 0);
}

TEST(MedialSweep, GoesOnWhereItWasStopped) {
  const Sweep sweep;
  sweep.report({"--sweep", "samples=150"});
  // What a sweep leaves that was stopped in its second run.
  for (const char* name : {"l-sweep.csv", "l-sweep.json"}) std::filesystem::remove(sweep.here / "out" / name);
  EXPECT_EQ(sweep.report({"--sweep", "samples=150,200"})["runs_taken_over"], 1);
  // Damage is no reason to fail.
  std::ofstream(sweep.here / "out/l-sweep-runs.json") << "{\"runs\": [3, {\"run\": ";
  EXPECT_EQ(sweep.report({"--sweep", "samples=150,200"})["runs_taken_over"], 0);
}

TEST(MedialSweep, KeepsTheFilesOfEachRunOnRequest) {
  const Sweep sweep;
  const std::vector<std::string> words{"--samples", "150", "--sweep", "vertices=10,20", "--keep", "--export", "ply"};
  const json report = sweep.report(words);
  for (const char* vertices : {"10", "20"}) {
    const auto files = sweep.here.files("out/l-sweep/vertices=" + std::string(vertices));
    for (const char* name : {"l.ma", "l-axis.ply", "l-simplified.ma", "l-medial.json"})
      EXPECT_TRUE(files.contains(name)) << name;
    const json kept = json::parse(files.at("l-medial.json"));
    EXPECT_EQ(kept["provenance"]["options"]["vertices"], vertices);
    EXPECT_FALSE(kept["provenance"]["options"].contains("sweep"));
    EXPECT_TRUE(kept["quality"]["hausdorff_max"].is_number());
  }
  EXPECT_EQ(sweep.report(words)["runs_taken_over"], 2);
  std::filesystem::remove(sweep.here / "out/l-sweep/vertices=10/l.ma");
  EXPECT_EQ(sweep.report(words)["runs_taken_over"], 1) << "what is missing is made again";
  const Finished alone = sweep.here.run({"medial", sweep.mesh, "-o", sweep.out, "--keep"});
  EXPECT_EQ(alone.exit_code, 2);
  EXPECT_NE(alone.err.find("--keep has no effect without --sweep"), std::string::npos) << alone.err;
}

TEST(MedialSweep, RefusesWhatItCannotVary) {
  const Sweep sweep;
  for (const auto& [text, word] : {std::pair{"output=a,b", "no option with values to compare is called output"},
                                   {"raw=yes,no", "no option with values to compare is called raw"},
                                   {"vertices=10,none", "vertices=none"},
                                   {"vertices=10,-1", "vertices=-1"},
                                   {"balls=medial,free", "--balls has no effect without"},
                                   {"vertices=10,10", "10 is given twice"}}) {
    const Finished run = sweep.run({"--sweep", text});
    EXPECT_EQ(run.exit_code, 2) << text;
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  }
  EXPECT_EQ(sweep.run({"--sweep", "vertices=10,20", "--error", "1"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(sweep.out));
}

}  // namespace
}  // namespace orchard
