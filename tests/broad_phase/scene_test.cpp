#include <gtest/gtest.h>

#include "../runtime/every_machine.h"
#include "any_broad_phase.h"
#include "oracles.h"
#include "scenes.h"

// Every scene of the benchmarks' table, with a thousand bodies, against comparing all of them.
namespace orchard::runtime {
namespace {

constexpr std::size_t kSceneBodies = 1000;

using SceneReports = std::vector<std::vector<BodyPair>>;  // by step

std::vector<test::SceneSpec> small_scenes() {
  std::vector<test::SceneSpec> scenes;
  for (test::SceneSpec spec : test::table_scenes(10000)) {
    spec.bodies = kSceneBodies;
    const bool twice = std::any_of(scenes.begin(), scenes.end(), [&](const test::SceneSpec& other) {
      return other.kind == spec.kind && other.share == spec.share;
    });
    if (!twice) scenes.push_back(spec);
  }
  return scenes;
}

SceneReports expected(const test::SceneSpec& spec, int steps) {
  test::TableScene scene(spec, 1);
  SceneReports reports;
  std::vector<Motion> motions(scene.size());
  for (int step = 0; step < steps; ++step, scene.next_step()) {
    for (BodyIndex i = 0; i < scene.size(); ++i) motions[i] = scene.motion(i);
    reports.push_back(test::touching_pairs(motions));
  }
  return reports;
}

void expect_reports(const test::SceneSpec& spec, const test::AnyOptions& options, const SceneReports& reports) {
  test::TableScene scene(spec, 1);
  test::SceneWorld world(scene, test::make_broad_phase(scene.source(), options));
  for (std::size_t step = 0; step < reports.size(); ++step, scene.next_step()) {
    const Advance now = world.step(scene);
    ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), reports[step])
        << spec.name << ", step " << step << ", method " << static_cast<int>(options.method);
  }
}

class EveryScene : public testing::TestWithParam<test::SceneSpec> {
 protected:
  // Bounds of the first second, and the next ones; where all touch all, a few steps show as much.
  static int steps() { return GetParam().kind == test::SceneKind::coincident ? 5 : 125; }
};

std::string name_of(const testing::TestParamInfo<test::SceneSpec>& info) {
  std::string name;
  bool begins = true;
  for (const char c : std::string(info.param.name)) {
    const bool letter = ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9');
    if (letter) name += begins && 'a' <= c && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    begins = !letter;
  }
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table, EveryScene, testing::ValuesIn(small_scenes()), name_of);

// As many as need no grid.
TEST_P(EveryScene, IsWhatBruteForceSaysOfFewBodies) {
  for (const std::size_t bodies : {3u, 70u, 180u}) {
    test::SceneSpec few = GetParam();
    few.bodies = bodies;
    const SceneReports reports = expected(few, steps());
    test::on_every_machine([&] { expect_reports(few, {}, reports); });
  }
}

TEST_P(EveryScene, IsWhatBruteForceSaysOnEveryMachine) {
  const SceneReports reports = expected(GetParam(), steps());
  test::on_every_machine([&] { expect_reports(GetParam(), {}, reports); });
  expect_reports(GetParam(), {.common = {.window = 20}}, reports);
}

// The dissertation's methods look at everything at each step where bodies overlap: few steps.
TEST_P(EveryScene, IsWhatBruteForceSaysByEveryMethod) {
  const SceneReports reports = expected(GetParam(), 3);
  for (const test::AnyMethod method : test::kMethods) expect_reports(GetParam(), {.method = method}, reports);
}

}  // namespace
}  // namespace orchard::runtime
