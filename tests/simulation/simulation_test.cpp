#include "simulation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "paraview.h"
#include "runtime/support.h"
#include "support/query_of_trees.h"

namespace orchard::simulation {
namespace {

using runtime::Answer;

const runtime::PackedSphereTree& tree() {
  static const runtime::PackedSphereTree made = runtime::test::build_tree(runtime::test::l_shape());
  return made;
}

std::vector<Shape> shapes() { return {shape_of(tree())}; }

std::size_t few(const std::string& scene) {
  return scene == "asteroids" || scene == "clusters" ? 60 : scene == "conveyor" ? 20 : 8;
}

class EveryScene : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(kSceneNames),
                         [](const auto& scene) { return std::string(scene.param); });

// At every step, pairs are counted whose spheres overlap, and those reported are the ones that a narrow phase which has
// all the time it wants says yes to.
TEST_P(EveryScene, FindsWhatBruteForceFindsAtEveryStep) {
  const auto world = make_world(GetParam(), shapes(), few(GetParam()), 1);
  runtime::test::OwnNarrowPhase pair(tree(), tree());
  std::size_t overlaps = 0;
  for (int step = 0; step < 100; ++step) {
    world->time = step * world->scene.step;
    world->scene.before(*world, world->time);
    const StepOutcome outcome = world->detection.step(world->time, {});
    std::set<std::pair<std::uint32_t, std::uint32_t>> found;
    for (const PairOutcome& p : outcome.pairs) {
      found.insert({p.a, p.b});
      ASSERT_EQ(p.verdict.answer, Answer::yes) << "step " << step;
    }
    ASSERT_EQ(found.size(), outcome.pairs.size());
    std::size_t overlaps_now = 0;
    for (std::uint32_t a = 0; a < world->bodies.size(); ++a) {
      for (std::uint32_t b = a + 1; b < world->bodies.size(); ++b) {
        const Body &one = world->bodies[a], &two = world->bodies[b];
        if (!one.there || !two.there || (one.fixed && two.fixed)) continue;
        const bool overlap = length(one.position - two.position) <= one.radius + two.radius;
        overlaps_now += overlap;
        bool touch = false;
        if (overlap) {
          pair.start(pose_of(one, world->shapes[0]), pose_of(two, world->shapes[0]));
          touch = pair.refine_exactly() == Answer::yes;
        }
        ASSERT_EQ(found.contains({a, b}), touch) << "step " << step << ", bodies " << a << " and " << b;
      }
    }
    ASSERT_EQ(outcome.overlapping, overlaps_now) << "step " << step;
    overlaps += overlaps_now;
    respond_and_move(*world, outcome);
  }
  if (GetParam() != std::string("asteroids")) {
    EXPECT_GT(overlaps, 0u);
  }
}

TEST_P(EveryScene, ReplaysToTheSameTrace) {
  const std::size_t bodies = few(GetParam());
  Simulation first(GetParam(), shapes(), bodies, 7);
  const Steering steering{0.5, -0.25, 1};
  std::string trace;
  // A budget in time: every run stops elsewhere, but for the replay.
  for (int frame = 0; frame < 30; ++frame)
    trace += trace_row(first.frame({.time = std::chrono::microseconds(20)}, steering));
  const Recording recording = parse_recording(to_text(first.recording()));
  Simulation again(GetParam(), shapes(), bodies, 7, &recording);
  std::string replayed;
  for (int frame = 0; frame < 30; ++frame) replayed += trace_row(again.frame({}));
  EXPECT_EQ(trace, replayed);
  EXPECT_THROW(again.frame({}), std::out_of_range);
}

TEST_P(EveryScene, WithoutABudgetReplaysToTheSameTraceToo) {
  Simulation first(GetParam(), shapes(), few(GetParam()), 7);
  std::string trace, replayed;
  for (int frame = 0; frame < 30; ++frame) trace += trace_row(first.frame({}));
  const Recording recording = parse_recording(to_text(first.recording()));
  Simulation again(GetParam(), shapes(), few(GetParam()), 7, &recording);
  for (int frame = 0; frame < 30; ++frame) replayed += trace_row(again.frame({}));
  EXPECT_EQ(trace, replayed);
}

TEST_P(EveryScene, NeverSpendsMuchMoreThanItsBudget) {
  constexpr std::uint64_t budget = 600, broad_unit = 2 * runtime::kMotionWork;
  Simulation simulation(GetParam(), shapes(), few(GetParam()), 3);
  for (int frame = 0; frame < 30; ++frame) {
    const auto steps = static_cast<std::uint64_t>(simulation.steps_per_frame());
    EXPECT_LT(simulation.frame({.work = budget * steps}).work, (budget + broad_unit + runtime::kMaxOvershoot) * steps);
  }
}

TEST_P(EveryScene, WritesFramesForParaView) {
  Simulation simulation(GetParam(), shapes(), few(GetParam()), 1);
  simulation.frame({});
  const std::string bodies = bodies_vtp(simulation), bounds = bounds_vtp(simulation);
  EXPECT_NE(bodies.find("separation_bound"), std::string::npos);
  EXPECT_NE(bounds.find("hypertrapezoid_half"), std::string::npos);
  std::size_t moving = 0;
  for (const Body& body : simulation.world().bodies) moving += body.there && !body.fixed;
  EXPECT_NE(bounds.find("NumberOfPolys=\"" + std::to_string(6 * moving) + '"'), std::string::npos) << "cubes";
  EXPECT_EQ(bodies.find(" nan"), std::string::npos) << "ParaView does not read it as text";
  EXPECT_EQ(bounds.find("inf"), std::string::npos);
}

TEST(Simulation, ChangesWithItsSeed) {
  Simulation one("flight", shapes(), 5, 1), two("flight", shapes(), 5, 2);
  EXPECT_NE(one.frame({}).state, two.frame({}).state);
}

TEST(Simulation, TheSteeredShipIsAJuggernautAndDronesJumpHome) {
  Simulation simulation("flight", shapes(), 3, 1);
  World& world = simulation.world();
  world.jump(1, world.bodies[0].position, {});
  const Vec3 home = world.bodies[1].home;
  simulation.frame({});
  EXPECT_LT(length(world.bodies[0].position), world.bodies[0].radius) << "it flies on";
  EXPECT_LT(length(world.bodies[1].position - home), world.bodies[1].radius);
}

TEST(Simulation, ThrottleAndRudderMoveTheSteeredShip) {
  Simulation still("flight", shapes(), 1, 1), steered("flight", shapes(), 1, 1);
  for (int frame = 0; frame < 10; ++frame) {
    still.frame({});
    steered.frame({}, {1, 1, 0});
  }
  EXPECT_EQ(length(still.world().bodies[0].position), 0);
  EXPECT_GT(length(steered.world().bodies[0].position), 0.1);
  EXPECT_NE(still.world().bodies[0].attitude, steered.world().bodies[0].attitude);
}

TEST(Simulation, APileComesToRestAboveTheFloor) {
  Simulation simulation("pile", shapes(), 6, 1);
  std::size_t touching = 0;
  for (int frame = 0; frame < 400; ++frame) touching += simulation.frame({}).yes > 0;
  EXPECT_GT(touching, 50u) << "bodies lie on each other";
  for (const Body& body : simulation.world().bodies) {
    EXPECT_GT(body.position[1], -3.2 * body.radius);
    EXPECT_LT(body.position[1], 6 * body.radius);
    EXPECT_LT(length(body.velocity), 3 * body.radius) << "per second";
  }
}

TEST(Simulation, AConveyorRemovesAndAddsBodies) {
  Simulation simulation("conveyor", shapes(), 12, 1);
  std::size_t most = 0;
  for (int frame = 0; frame < 400; ++frame) {
    EXPECT_EQ(simulation.frame({}).bodies, 12u);
    most = simulation.world().bodies.size();
  }
  EXPECT_GT(most, 20u) << "new ones came";
}

TEST(Simulation, ASmallerBudgetLeavesMoreOpenAtLowerLevels) {
  const runtime::PackedSphereTree ring = runtime::test::build_tree(runtime::test::torus(16, 8, 1, 0.4));
  std::size_t open[2] = {}, deep[2] = {};
  for (std::size_t run = 0; run < 2; ++run) {
    Simulation simulation("pile", {shape_of(ring)}, 8, 2);
    for (int frame = 0; frame < 150; ++frame) {
      const FrameRecord record = simulation.frame({.work = run == 0 ? 400u : 4000u});
      open[run] += record.maybe;
      for (std::size_t level = 2; level < kLevels; ++level) deep[run] += record.stopped[level];
    }
  }
  EXPECT_GT(open[0], open[1]);
  EXPECT_GT(open[0] - deep[0], open[1] - deep[1]) << "of those at the first levels";
}

TEST(Recording, SaysWhichLineIsWrong) {
  const auto fault = [](const std::string& text) {
    try {
      parse_recording(text);
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(fault("nothing").find("line 1"), std::string::npos);
  const std::string head = "orchard-recording 2\nflight 1 1 ab time\n";
  EXPECT_NE(fault("orchard-recording 2\nnowhere 1 1 ab none\n").find("line 2"), std::string::npos);
  EXPECT_NE(fault("orchard-recording 2\nflight 1 1 ab now\n").find("line 2"), std::string::npos);
  EXPECT_NE(fault(head + "0 0 0 12:-:-:-:- 13:-:-:-:-\n0 0 0 12:-:-:-:-\n").find("line 4"), std::string::npos);
  EXPECT_NE(fault(head + "0 9 0 12:-:-:-:-\n").find("line 3"), std::string::npos);
  for (const char* step : {"x", "12", "12:-:-:-", "12:-:-:-:-:", "12:-:-:-:-7", "12:-:-:-:99999999999999999999"})
    EXPECT_NE(fault(head + "0 0 0 " + step + "\n").find("line 3"), std::string::npos) << step;
  EXPECT_EQ(fault(head + "0 0 0 12:3:-:4:- -:-:-:-:-\n"), "");
}

}  // namespace
}  // namespace orchard::simulation
