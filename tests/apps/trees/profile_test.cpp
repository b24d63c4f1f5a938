#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

struct Trees {
  Workplace here;
  std::string mesh = here.add("l.obj", test::l_shape());
  std::string of_depth(int depth) const {
    const std::string folder = (here / ("depth" + std::to_string(depth))).string();
    const Finished run = here.run(
        {"build", mesh, "-o", folder, "--method", "octree", "--depth", std::to_string(depth), "--no-views", "--quiet"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return folder + "/l.orchard";
  }
  json profile(const std::vector<std::string>& arguments) const {
    std::vector<std::string> all{"profile"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"--json", "--flights", "40"});
    const Finished run = here.run(all);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return json::parse(run.out);
  }
};

// What no clock changes.
json counts(json report) {
  for (json& level : report["levels"]) level.erase("microseconds");
  return report;
}

TEST(Profile, DecidesEveryPoseThatIsApartByTheLastLevelAndEachOnce) {
  const Trees trees;
  const json report = trees.profile({trees.of_depth(2)});
  const json& levels = report["levels"];
  ASSERT_EQ(levels.size(), 4u) << "the roots, two levels, the triangles";
  EXPECT_GT(report["poses"], 40);
  EXPECT_LT(report["separated"], report["poses"]) << "some flights end in a touch";
  EXPECT_EQ(levels[0]["poses"], report["poses"]);
  std::size_t decided = 0;
  double share = 0;
  for (const json& level : levels) {
    EXPECT_EQ(level["poses"].get<std::size_t>(), report["poses"].get<std::size_t>() - decided);
    decided += level["decided_no"].get<std::size_t>();
    EXPECT_GE(level["decided_of_separated"], share);
    share = level["decided_of_separated"];
    EXPECT_EQ(level["maybe_though_separated"].get<std::size_t>(), report["separated"].get<std::size_t>() - decided);
  }
  EXPECT_EQ(decided, report["separated"].get<std::size_t>());
  EXPECT_EQ(share, 1.0);
}

TEST(Profile, BoundsFallFromLevelToLevelAndFillTheirHistograms) {
  const Trees trees;
  const json levels = trees.profile({trees.of_depth(3)})["levels"];
  for (std::size_t i = 1; i + 1 < levels.size(); ++i) {
    std::size_t poses = 0;
    for (const json& bin : levels[i]["bound_histogram"]) poses += bin.get<std::size_t>();
    EXPECT_EQ(poses, levels[i]["poses"].get<std::size_t>() - levels[i]["decided_no"].get<std::size_t>());
    if (i > 1) {
      EXPECT_LT(levels[i]["bound_over_radius"]["median"], levels[i - 1]["bound_over_radius"]["median"]);
    }
  }
}

TEST(Profile, ADeeperTreeDecidesMore) {
  const Trees trees;
  const json one = trees.profile({trees.of_depth(1)}), three = trees.profile({trees.of_depth(3)});
  EXPECT_EQ(one["separated"], three["separated"]) << "of the same flights";
  EXPECT_EQ(one["levels"][1]["decided_no"], three["levels"][1]["decided_no"]);
  EXPECT_GT(three["levels"][3]["decided_of_separated"], one["levels"][1]["decided_of_separated"]);
}

TEST(Profile, RepeatsItselfForASeedAndChangesWithIt) {
  const Trees trees;
  const std::string tree = trees.of_depth(1);
  EXPECT_EQ(counts(trees.profile({tree})), counts(trees.profile({tree})));
  EXPECT_NE(counts(trees.profile({tree}))["levels"], counts(trees.profile({tree, "--seed", "2"}))["levels"]);
}

TEST(Profile, OfTwoBodiesWritesEveryPoseAndThePlot) {
  const Trees trees;
  const std::string a = trees.of_depth(2), csv = (trees.here / "poses.csv").string();
  trees.profile({a, trees.of_depth(1), "--csv", csv, "--plot", (trees.here / "profile.svg").string()});
  const auto files = trees.here.files("");
  EXPECT_NE(files.at("profile.svg").find("level 1"), std::string::npos);
  std::istringstream lines(test::without_provenance(files.at("poses.csv")));
  std::string line;
  std::getline(lines, line);
  std::size_t rows = 0, no = 0, yes = 0;
  while (std::getline(lines, line)) {
    ++rows;
    no += line.find(",no,") != std::string::npos;
    yes += line.find(",yes,") != std::string::npos;
  }
  EXPECT_GT(rows, no + yes);
  EXPECT_GT(no, 0u);
  EXPECT_GT(yes, 0u);
}

TEST(Profile, RefusesWhatItCannotReadOrWrite) {
  const Trees trees;
  const std::string tree = trees.of_depth(1);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"profile", trees.mesh},
        {"profile", tree, "nowhere.orchard"},
        {"profile", tree, "--plot", (trees.here / "none" / "p.svg").string()},
        {"profile", tree, "--flights", "0"}}) {
    const Finished run = trees.here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments.back();
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
}

}  // namespace
}  // namespace orchard
