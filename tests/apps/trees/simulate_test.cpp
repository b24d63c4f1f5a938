#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using nlohmann::json;
using test::Finished;
using test::Workplace;

TEST(Simulate, PlaysEverySceneWithItsOwnShip) {
  const Workplace here;
  for (const char* scene : {"flight", "pile", "asteroids", "robot", "box", "conveyor", "clusters"}) {
    const Finished run = here.run({"simulate", scene, "--frames", "5", "--bodies", "8", "--json"});
    ASSERT_EQ(run.exit_code, 0) << scene << run.err;
    const json report = json::parse(run.out);
    EXPECT_EQ(report["frames"], 5) << scene;
    EXPECT_GE(report["bodies"], 8) << scene;
  }
}

TEST(Simulate, AReplayGivesTheSameTrace) {
  const Workplace here;
  const std::string record = (here / "run.txt").string();
  Finished run = here.run({"simulate", "flight", "--frames", "40", "--seed", "5", "--budget", "50us", "--record",
                           record, "-o", (here / "first").string(), "--no-views", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  run = here.run({"simulate", "flight", "--replay", record, "-o", (here / "again").string(), "--no-views", "--quiet"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto first = here.files("first"), again = here.files("again");
  const std::string trace = test::without_provenance(first.at("flight-trace.csv"));
  EXPECT_EQ(trace, test::without_provenance(again.at("flight-trace.csv")));
  EXPECT_EQ(std::count(trace.begin(), trace.end(), '\n'), 41) << "a header and the frames";
  EXPECT_EQ(first.size(), 3u) << "trace, times and report";
}

TEST(Simulate, TakesAnyTreeAndWritesTheRunForParaView) {
  const Workplace here;
  const std::string mesh = here.add("u.obj", test::u_shape(0.3)), trees = (here / "trees").string();
  ASSERT_EQ(here.run(test::quick_build(mesh, trees)).exit_code, 0);
  const Finished run = here.run({"simulate", "box", "--tree", trees + "/u.orchard", "--frames", "3", "--bodies", "4",
                                 "-o", (here / "out").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto files = here.files("out");
  EXPECT_TRUE(files.contains("box-frame-00002-bodies.vtp"));
  EXPECT_TRUE(files.contains("box-frame-00002-bounds.vtp"));
  const std::string& pvd = files.at("box-run.pvd");
  EXPECT_NE(pvd.find("box-frame-00000-bodies.vtp"), std::string::npos);
  for (std::size_t at = pvd.find("file=\""); at != std::string::npos; at = pvd.find("file=\"", at + 1))
    EXPECT_TRUE(files.contains(pvd.substr(at + 6, pvd.find('"', at + 6) - at - 6)));
}

TEST(Simulate, RefusesWhatItCannotRun) {
  const Workplace here;
  const std::string record = (here / "run.txt").string();
  ASSERT_EQ(here.run({"simulate", "pile", "--frames", "2", "--bodies", "2", "--record", record, "--quiet"}).exit_code,
            0);
  const std::string mesh = here.add("u.obj", test::u_shape(0.3)), trees = (here / "trees").string();
  ASSERT_EQ(here.run(test::quick_build(mesh, trees)).exit_code, 0);
  const std::string broken = here.add("broken.txt", std::string("orchard-recording 2\npile 2 1\n"));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"simulate", "regatta"},
        {"simulate", "pile", "--budget", "soon"},
        {"simulate", "pile", "--budget", "0"},
        {"simulate", "pile", "--replay", record, "--budget", "5"},
        {"simulate", "pile", "--replay", record, "--frames", "3"},
        {"simulate", "box", "--replay", record},
        {"simulate", "pile", "--replay", record, "--tree", trees + "/u.orchard"},
        {"simulate", "pile", "--replay", broken},
        {"simulate", "pile", "--tree", mesh},
        {"simulate", "pile", "--no-views"}}) {
    const Finished run = here.run(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments.back();
    EXPECT_TRUE(test::is_one_line_error(run.err)) << run.err;
  }
}

}  // namespace
}  // namespace orchard
