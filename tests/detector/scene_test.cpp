#include <gtest/gtest.h>

#include <cstring>

#include "runtime/allocation.h"
#include "scene_oracle.h"
#include "scene_run.h"
#include "support/effort.h"

// Every scene against brute force over all pairs at every step.
namespace orchard::runtime {
namespace {

using test::Promises;
using test::Scene;
using test::SceneRun;
using test::Touching;

// ORCHARD_MORE: 2.5 million pairs of bodies at a step, instead of 120,000.
const bool kMore = orchard::test::more() > 1;
const std::size_t kSceneBodies = kMore ? 60 : 30;
const int kSceneSteps = kMore ? 200 : 40;

struct Case {
  const Scene* scene;
  std::vector<test::StepTruth> truth;
};

// Once for all tests: the oracle is what takes time.
const std::vector<Case>& cases() {
  static const std::vector<Scene> scenes =
      test::every_scene(kSceneBodies, kSceneSteps, 1 + orchard::test::first_seed());
  static const std::vector<Case> made = [] {
    std::vector<Case> result;
    for (const Scene& scene : scenes) {
      const test::SceneOracle oracle(scene);
      Case& c = result.emplace_back(Case{&scene, {}});
      for (int step = 0; step < scene.steps; ++step) c.truth.push_back(oracle.at(step));
    }
    return result;
  }();
  return made;
}

struct Answers {
  Touching yes, maybe;
};

Answers answers_of(const SceneRun& run, const Frame& frame) {
  Answers answers;
  for (const PairEvent& event : frame.events) {
    if (event.change == PairChange::end) continue;
    if (event.verdict.answer == Answer::yes) answers.yes.insert(run.numbers(event));
    if (event.verdict.answer == Answer::maybe) answers.maybe.insert(run.numbers(event));
  }
  return answers;
}

Touching without(const Touching& from, const Touching& what) {
  Touching rest;
  for (const auto& pair : from) {
    if (what.count(pair) == 0) rest.insert(pair);
  }
  return rest;
}

TEST(Scenes, HaveContactsThatBeginAndEnd) {
  for (const Case& c : cases()) {
    std::size_t pairs = 0, changes = 0;
    for (std::size_t step = 0; step < c.truth.size(); ++step) {
      pairs += c.truth[step].touching.size();
      changes += step > 0 && c.truth[step].touching != c.truth[step - 1].touching;
    }
    EXPECT_GT(pairs, 20u) << c.scene->name;
    EXPECT_GT(changes, 2u) << c.scene->name;
  }
}

class EveryPromise : public testing::TestWithParam<Promises> {};
INSTANTIATE_TEST_SUITE_P(Detector, EveryPromise,
                         testing::Values(Promises::known, Promises::watched, Promises::suggested));

TEST_P(EveryPromise, TellsExactlyWhoTouchesAtEachStep) {
  for (const Case& c : cases()) {
    SceneRun run(*c.scene, {}, GetParam());
    for (int step = 0; step < c.scene->steps; ++step) {
      const Frame frame = run.step(step);
      const auto& truth = c.truth[static_cast<std::size_t>(step)];
      const Answers answers = answers_of(run, frame);
      ASSERT_TRUE(answers.maybe.empty()) << c.scene->name << " at " << step;
      ASSERT_EQ(without(answers.yes, truth.close), without(truth.touching, truth.close))
          << c.scene->name << " at step " << step;
      ASSERT_EQ(frame.certain, frame.pairs);
      ASSERT_TRUE(frame.refused.empty());
      ASSERT_FALSE(frame.out_of_memory);
    }
    if (GetParam() != Promises::suggested) {
      EXPECT_EQ(run.detector().motion_bound_violations(), 0u) << c.scene->name;
    }
  }
}

// Begin and end alternate, and what stays is between them.
TEST(Detector, EventsOfAPairAlternate) {
  for (const Case& c : cases()) {
    SceneRun run(*c.scene, {});
    std::map<std::pair<std::size_t, std::size_t>, bool> touching;
    for (int step = 0; step < c.scene->steps; ++step) {
      for (const PairEvent& event : run.step(step).events) {
        bool& touch = touching[run.numbers(event)];
        EXPECT_EQ(touch, event.change == PairChange::stay || event.change == PairChange::end) << c.scene->name;
        touch = event.change == PairChange::begin || event.change == PairChange::stay;
        EXPECT_NEAR(event.time, step * c.scene->dt, 1e-12);
      }
    }
  }
}

TEST(Detector, WithinABudgetOnlySaysWhatIsTrue) {
  for (const Case& c : cases()) {
    std::size_t certain = 0, possible = 0;
    for (const std::uint64_t work :
         {std::uint64_t{1}, std::uint64_t{300}, std::uint64_t{2000}, std::uint64_t{20'000}}) {
      SceneRun run(*c.scene, {}, Promises::known);
      for (int step = 0; step < c.scene->steps; ++step) {
        const Frame frame = run.step(step, {.work = work});
        const auto& truth = c.truth[static_cast<std::size_t>(step)];
        const Answers answers = answers_of(run, frame);
        // Besides one unit that the broad phase gets in any case: a pair's two motions.
        EXPECT_LT(frame.work, work + kMaxOvershoot + 2 * kMotionWork) << c.scene->name;
        EXPECT_TRUE(without(without(answers.yes, truth.touching), truth.close).empty()) << c.scene->name;
        if (frame.unfinished.incomplete_from == kNoClass) {
          Touching known = answers.yes;
          known.insert(answers.maybe.begin(), answers.maybe.end());
          ASSERT_TRUE(without(without(truth.touching, known), truth.close).empty())
              << c.scene->name << " at step " << step << " with " << work;
        }
        certain += frame.certain, possible += frame.pairs - frame.certain;
      }
    }
    EXPECT_GT(certain, 0u) << c.scene->name;
    EXPECT_GT(possible, 0u) << c.scene->name;
  }
}

// 10,000; with ORCHARD_MORE 100,000.
TEST(Detector, AnswersAWholeAsteroidField) {
  const Scene scene = test::asteroid_field(kMore ? 100'000 : 10'000, kMore ? 3 : 4, 3 + orchard::test::first_seed());
  const test::SceneOracle oracle(scene);
  SceneRun run(scene, {}, Promises::known), within(scene, {}, Promises::known);
  for (int step = 0; step < scene.steps; ++step) {
    const auto truth = oracle.at(step);
    const Answers answers = answers_of(run, run.step(step));
    ASSERT_TRUE(answers.maybe.empty());
    ASSERT_GT(truth.touching.size(), scene.bodies.size() / 20);
    ASSERT_EQ(answers.yes, truth.touching) << "step " << step;
    const std::uint64_t work = 10 * scene.bodies.size();
    const Frame frame = within.step(step, {.work = work});
    EXPECT_LT(frame.work, work + kMaxOvershoot + 2 * kMotionWork);
    const Answers known = answers_of(within, frame);
    EXPECT_TRUE(without(known.yes, truth.touching).empty());
    if (frame.unfinished.incomplete_from == kNoClass) {
      EXPECT_TRUE(without(without(truth.touching, known.yes), known.maybe).empty());
    }
  }
}

// A clock ends each run elsewhere, within the broad phase or at any pair, but for the replay.
TEST(Detector, ReplaysWhatABudgetInTimeHasCutShort) {
  std::size_t cuts = 0;
  for (const Case& c : cases()) {
    const int steps = std::min(c.scene->steps, 12);
    std::vector<StepCut> taken;
    std::vector<double> first, again;
    SceneRun run(*c.scene, {}), replay(*c.scene, {});
    for (int step = 0; step < steps; ++step) {
      const Frame frame = run.step(step, {.time = std::chrono::microseconds(1 + 5 * step)});
      test::append(first, frame);
      taken.push_back(frame.cut);
      cuts += frame.cut != StepCut{};
    }
    for (int step = 0; step < steps; ++step) {
      const auto at = static_cast<std::size_t>(step);
      const Frame frame = replay.step(step, {}, {.replay = &taken[at]});
      test::append(again, frame);
      EXPECT_EQ(frame.cut, taken[at]) << c.scene->name << ", step " << step;
    }
    ASSERT_EQ(first.size(), again.size()) << c.scene->name;
    ASSERT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(double)), 0) << c.scene->name;
  }
  EXPECT_GT(cuts, 20u);
}

// How much there was of anything at once: what a detector needs room for.
struct Load {
  std::uint64_t pairs = 0, motions = 0, waiting = 0;
  void take(const Frame& frame) {
    pairs = std::max(pairs, frame.pairs);
    motions = std::max(motions, frame.motions_asked);
    waiting = std::max(waiting, std::uint64_t{frame.unfinished.left_over});
  }
  bool is_within(const Load& other) const {
    return pairs <= other.pairs && motions <= other.motions && waiting <= other.waiting;
  }
};

TEST(Detector, AllocatesNothingOnceWarm) {
  std::size_t warm = 0;
  for (const Case& c : cases()) {
    if (c.scene->name == "conveyor") continue;  // adding bodies may
    for (const std::uint64_t work : {Budget{}.work, std::uint64_t{5000}}) {
      SceneRun run(*c.scene, {});
      int step = 0;
      Load first, later;
      for (; step < 8 * c.scene->steps; ++step) first.take(run.step(step, {.work = work}));
      const std::size_t before = test::allocations;
      const std::size_t bytes = run.detector().memory_bytes();
      for (; step < 12 * c.scene->steps; ++step) later.take(run.step(step, {.work = work}));
      if (!later.is_within(first)) continue;
      ++warm;
      // What a small budget leaves waiting, class by class, is more than ever at some time or other: a list or two
      // grow.
      const std::size_t lists = work == Budget{}.work ? 0 : 2;
      EXPECT_LE(test::allocations - before, lists) << c.scene->name << " with " << work;
      EXPECT_LE(run.detector().memory_bytes(), bytes + lists * bytes / 50) << c.scene->name << " with " << work;
    }
  }
  EXPECT_GT(warm, 0u);
}

}  // namespace
}  // namespace orchard::runtime
