#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "orchard/runtime/collide.h"
#include "scene_run.h"
#include "support/effort.h"
#include "thread_pool.h"

// What runs on an executor's threads, and nothing else: for the thread sanitizer, under which a test costs thirty times
// what it does otherwise.
namespace orchard::runtime {
namespace {

// What a scene's frames say, with so many threads; 0: without an executor.
std::vector<double> frames_of(const test::Scene& scene, std::uint64_t work, std::size_t threads) {
  test::ThreadPool pool(std::max<std::size_t>(threads, 1));
  DetectorOptions options;
  if (threads > 0) options.executor = pool.executor();
  test::SceneRun run(scene, options);
  std::vector<double> all;
  for (int step = 0; step < scene.steps; ++step) test::append(all, run.step(step, {.work = work}));
  return all;
}

void expect_same_frames(const test::Scene& scene, std::uint64_t work) {
  const std::vector<double> serial = frames_of(scene, work, 0);
  for (const std::size_t threads : {1u, 2u, 3u}) {
    const std::vector<double> all = frames_of(scene, work, threads);
    ASSERT_EQ(all.size(), serial.size()) << scene.name;
    ASSERT_EQ(std::memcmp(all.data(), serial.data(), all.size() * sizeof(double)), 0)
        << scene.name << " with " << threads << " threads";
  }
}

TEST(Threads, GiveTheSameFramesWhateverTheirNumber) {
  const bool more = orchard::test::more() > 1;
  for (const test::Scene& scene : test::every_scene(more ? 60 : 24, more ? 200 : 12, 1 + orchard::test::first_seed())) {
    for (const std::uint64_t work : {Budget{}.work, std::uint64_t{5000}}) expect_same_frames(scene, work);
  }
}

// The parts of one pair are tasks that run at once: what one of them finds is nothing that another may go by.
TEST(Threads, GiveTheSameFramesOfArticulatedBodiesWithinABudget) {
  expect_same_frames(test::robot_arm(60, 200, 1'000'000'007 + orchard::test::first_seed()), 5000);
}

// So many that the broad phase's jobs run at once, too: at the step at which all promises expire.
TEST(Threads, ShareWhatTheBroadPhaseDoes) {
  const test::Scene scene = test::falling_pile(4200, 11, 5 + orchard::test::first_seed());
  std::vector<double> serial;
  for (const std::size_t threads : {1u, 2u}) {
    test::ThreadPool pool(threads);
    DetectorOptions options;
    if (threads > 1) options.executor = pool.executor();
    test::SceneRun run(scene, options);
    std::vector<double> all;
    for (int step = 0; step < scene.steps; ++step) test::append(all, run.step(step));
    if (threads == 1) serial = all;
    ASSERT_EQ(all.size(), serial.size());
    ASSERT_EQ(std::memcmp(all.data(), serial.data(), all.size() * sizeof(double)), 0);
  }
}

// Where the clock ends a step no two runs are the same, but the pairs that are certain are all the same.
TEST(Threads, AreRightWhereverTheClockEndsAStep) {
  const test::Scene scene = test::falling_pile(40, 12, 3);
  test::ThreadPool pool(2);
  DetectorOptions options;
  options.executor = pool.executor();
  test::SceneRun exact(scene, {}), run(scene, options);
  for (int step = 0; step < scene.steps; ++step) {
    std::map<std::pair<std::size_t, std::size_t>, bool> touching;
    for (const PairEvent& event : exact.step(step).events) {
      touching[exact.numbers(event)] = event.verdict.answer == Answer::yes;
    }
    for (const PairEvent& event : run.step(step, {.time = std::chrono::microseconds(30 * step)}).events) {
      if (event.verdict.answer != Answer::yes) continue;
      EXPECT_TRUE(touching[run.numbers(event)]) << step;
    }
  }
}

TEST(Threads, ShareTreesInBatches) {
  const PackedSphereTree tree = test::build_tree(test::torus(10, 6, 1, 0.4));
  const PreparedTree prepared(tree);
  const TreePair pair(prepared, prepared);
  std::vector<Pose> a, b;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    test::Draw draw(seed);
    a.push_back(draw.pose(0)), b.push_back(draw.pose(draw.uniform(0, 2.8)));
  }
  std::vector<Answer> serial;
  for (const std::size_t threads : {1u, 3u}) {
    test::ThreadPool pool(threads);
    std::vector<Workspace> workspaces(threads);
    std::vector<Verdict> verdicts(a.size());
    std::vector<Distance> distances(a.size());
    share_among(pool.executor(), threads, a.size(), [&](std::size_t job, std::size_t i) {
      verdicts[i] = collide(workspaces[job], pair, a[i], b[i]);
      distances[i] = distance(workspaces[job], pair, a[i], b[i]);
    });
    std::vector<Answer> answers;
    for (std::size_t i = 0; i < verdicts.size(); ++i) {
      answers.push_back(verdicts[i].answer);
      EXPECT_EQ(distances[i].lower > 0, verdicts[i].answer == Answer::no) << i;
    }
    if (threads == 1) serial = answers;
    EXPECT_EQ(answers, serial);
  }
}

}  // namespace
}  // namespace orchard::runtime
