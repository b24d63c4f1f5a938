// `orchard medial --axis` on files of other systems.
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

Finished judged(const Workplace& here, const std::string& axis, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words{"medial",
                                 here.add("rod.obj", test::box({0, 0, 0}, {6, 2, 2})),
                                 "-o",
                                 (here / "out").string(),
                                 "--axis",
                                 axis,
                                 "--quality-samples",
                                 "300",
                                 "--json",
                                 "--force"};
  words.insert(words.end(), more.begin(), more.end());
  return here.run(words);
}

TEST(ForeignAxis, IsMeasuredWhateverItsKindAndSaysWhatIsMissing) {
  const Workplace here;
  const Finished run = judged(here, here.add("a.obj", std::string("v 1 1 1\nv 3 1 1\nv 5 1 1\nl 1 2 3\n")));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["edges"], 2);
  EXPECT_NE(report["notes"][0].get<std::string>().find("no radii"), std::string::npos);
  EXPECT_LT(report["quality"]["radius_error_max"].get<double>(), 1e-9);
  EXPECT_TRUE(report["quality"]["chamfer"].is_number());
  EXPECT_TRUE(report["quality"]["triangle_quality_mean"].is_null());
}

TEST(ForeignAxis, IsConnectedAndWrittenInOtherFormatsOnRequest) {
  const Workplace here;
  const std::string balls = here.add("a.txt", std::string("1 1 1 1\n3 1 1 1\n5 1 1 1\n"));
  const Finished run = judged(here, balls, {"--connect", "--export", "ma,ply,obj,graphml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(json::parse(run.out)["edges"], 2);
  const auto files = here.files("out");
  EXPECT_EQ(files.at("a-converted.ma").substr(0, 6), "3 2 0\n");
  EXPECT_NE(files.at("a-converted.ply").find("property double radius"), std::string::npos);
  EXPECT_NE(files.at("a-converted.obj").find("l 1 2"), std::string::npos);
  EXPECT_NE(files.at("a-converted.graphml").find("<edge source=\"n0\" target=\"n1\">"), std::string::npos);
  const Finished again = judged(here, (here / "out/a-converted.ply").string());
  EXPECT_EQ(json::parse(again.out)["edges"], 2);
  EXPECT_EQ(here.run({"medial", (here / "rod.obj").string(), "-o", (here / "x").string(), "--connect"}).exit_code, 2);
}

TEST(ForeignAxis, ThatIsInAnotherFrameOrCannotBeReadEndsWithExitCodeTwo) {
  const Workplace here;
  const Finished frame = judged(here, here.add("a.ma", std::string("3 0 0\nv 101 1 1 1\nv 103 1 1 1\nv 105 1 1 1\n")));
  EXPECT_EQ(frame.exit_code, 2);
  EXPECT_NE(frame.err.find("scaled by 1 and then moved by (-100, 0, 0)"), std::string::npos) << frame.err;
  const Finished cut = judged(here, here.add("b.ma", std::string("3 0 0\nv 1 1 1 1\nv 3")));
  EXPECT_EQ(cut.exit_code, 2);
  EXPECT_NE(cut.err.find("b.ma, line 3"), std::string::npos) << cut.err;
  EXPECT_EQ(judged(here, here.add("c.stl", std::string("solid\n"))).exit_code, 2);
}

}  // namespace
}  // namespace orchard
