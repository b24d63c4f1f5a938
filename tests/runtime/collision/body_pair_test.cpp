#include "orchard/runtime/collide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "allocation.h"
#include "bodies.h"
#include "improper_poses.h"
#include "orchard/runtime/self_collision.h"
#include "support/effort.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

bool same_verdict(const Verdict& p, const Verdict& q) {
  return p.answer == q.answer && p.separation_bound == q.separation_bound && p.lower_bound == q.lower_bound &&
         p.level == q.level && p.work == q.work && p.contact.center == q.contact.center &&
         p.contact.triangle_a == q.contact.triangle_a && p.contact.triangle_b == q.contact.triangle_b;
}

std::vector<PreparedTree> prepared(const std::vector<Body>& bodies) {
  std::vector<PreparedTree> result;
  result.reserve(bodies.size());
  for (const Body& body : bodies) result.emplace_back(body.tree);
  return result;
}

struct PairCase {
  std::size_t a, b;
  Pose at_a, at_b;
};

PairCase random_case(const std::vector<Body>& all, std::uint64_t seed) {
  Draw draw(seed);
  const std::size_t i = draw.bits() % all.size(), j = draw.bits() % all.size();
  const double reach = all[i].tree.bounding_radius + all[j].tree.bounding_radius;
  return {i, j, centered(all[i].tree, draw.pose(0)), centered(all[j].tree, draw.pose(draw.uniform(0, 1.1) * reach))};
}

TEST(TreePair, IsSmallAndAnswersAsANarrowPhaseOfItsOwn) {
  EXPECT_LE(sizeof(TreePair), 256u);
  const auto all = bodies();
  const auto trees = prepared(all);
  Workspace workspace;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const PairCase c = random_case(all, seed);
    test::OwnNarrowPhase own(all[c.a].tree, all[c.b].tree);
    const Budget budget = {.work = seed % 3 == 0 ? 200 : Budget{}.work};
    for (const Order order : {Order::exact_first, Order::level_by_level}) {
      ASSERT_TRUE(same_verdict(collide(workspace, TreePair(trees[c.a], trees[c.b]), c.at_a, c.at_b, budget, order),
                               collide(own, c.at_a, c.at_b, budget, order)))
          << seed;
    }
    test::OwnDistanceQuery measure(all[c.a].tree, all[c.b].tree);
    measure.start(c.at_a, c.at_b);
    measure.refine();
    const Distance shared = distance(workspace, TreePair(trees[c.a], trees[c.b]), c.at_a, c.at_b);
    ASSERT_EQ(shared.lower, measure.lower()) << seed;
    ASSERT_EQ(shared.upper, measure.upper()) << seed;
  }
}

TEST(TreePair, AllocatesNothingOnceTheWorkspaceIsWarm) {
  const auto all = bodies();
  const auto trees = prepared(all);
  Workspace workspace;
  const auto ask_everything = [&] {
    for (std::size_t i = 0; i < trees.size(); ++i) {
      for (std::size_t j = 0; j < trees.size(); ++j) {
        TreePair pair(trees[i], trees[j]);
        const Pose at = centered(all[j].tree, Draw(i).pose(all[i].tree.bounding_radius));
        collide(workspace, pair, centered(all[i].tree, {}), at);
        collide_coherently(workspace, pair, centered(all[i].tree, {}), at);
        closer_than(workspace, pair, centered(all[i].tree, {}), at, 0.1);
        distance(workspace, pair, centered(all[i].tree, {}), at);
      }
    }
  };
  ask_everything();
  const std::size_t before = allocations;
  ask_everything();
  EXPECT_EQ(allocations, before);
}

TEST(TreePair, AnswersMirroredAndForCopiesInAnotherPlace) {
  const auto all = bodies();
  const auto trees = prepared(all);
  Body again = all[3];  // a copy with arrays of its own
  const PreparedTree copy(again.tree);
  EXPECT_EQ(copy.fingerprint, trees[3].fingerprint);
  Workspace workspace;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    const Pose a = draw.pose(0), b = draw.pose(draw.uniform(1.5, 2.5));
    const Verdict one = collide(workspace, TreePair(trees[3], trees[3]), a, b);
    const Verdict two = collide(workspace, TreePair(trees[3], copy), a, b);
    const Verdict other = collide(workspace, TreePair(copy, trees[3]), b, a);
    ASSERT_TRUE(same_verdict(one, two)) << seed;
    ASSERT_EQ(one.answer, other.answer) << seed;
    ASSERT_EQ(one.work, other.work) << seed;
    ASSERT_EQ(one.contact.triangle_a, other.contact.triangle_b) << seed;
  }
}

TEST(Budget, DecidesAtOnceWhatIsEasyToDecideExactly) {
  const auto all = bodies();
  int first = 0, levels = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const PairCase c = random_case(all, seed);
    test::OwnNarrowPhase pair(all[c.a].tree, all[c.b].tree);
    const Budget budget = {.work = 500};
    first += collide(pair, c.at_a, c.at_b, budget).answer != Answer::maybe;
    levels += collide(pair, c.at_a, c.at_b, budget, Order::level_by_level).answer != Answer::maybe;
  }
  EXPECT_GT(first, levels + 20);
}

TEST(CloserThan, AgreesWithTheDistanceByBruteForce) {
  const auto all = bodies();
  const auto trees = prepared(all);
  Workspace workspace;
  int yes = 0, no = 0;
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 250 * orchard::test::more(); ++seed) {
    const PairCase c = random_case(all, seed);
    const TreePair pair(trees[c.a], trees[c.b]);
    const auto truth = static_cast<double>(
        surface_distance(placed_triangles(all[c.a].tree, c.at_a), placed_triangles(all[c.b].tree, c.at_b)));
    const double rounding = 1e-7 * (1 + all[c.a].tree.bounding_radius) + 1e-9 * 3000;
    for (const double margin : {truth / 2, truth + 2 * rounding, 2 * truth + 0.1, 0.05}) {
      if (std::fabs(margin - truth) < rounding && margin != 0) continue;
      const Answer answer = closer_than(workspace, pair, c.at_a, c.at_b, margin);
      ASSERT_EQ(answer, truth <= margin ? Answer::yes : Answer::no) << seed << " " << truth << " " << margin;
      (answer == Answer::yes ? yes : no) += 1;
    }
  }
  EXPECT_GT(yes, 100);
  EXPECT_GT(no, 100);
}

TEST(CloserThan, IsUnsureOfWhatItCannotKnow) {
  const auto tree = build_tree(box({-1, -1, -1}, {1, 1, 1}));
  const PreparedTree cube(tree);
  Workspace workspace;
  const TreePair pair(cube, cube);
  const Pose away{.translation = {5, 0, 0}};
  EXPECT_EQ(closer_than(workspace, pair, {}, away, std::numeric_limits<double>::quiet_NaN()), Answer::maybe);
  EXPECT_EQ(closer_than(workspace, pair, {}, away, -1), Answer::maybe);
  EXPECT_EQ(closer_than(workspace, pair, {}, away, std::numeric_limits<double>::infinity()), Answer::yes);
  EXPECT_EQ(closer_than(workspace, pair, {}, Pose{.translation = {2, 0, 0}}, 0), Answer::yes);
  for (const auto& [name, pose] : improper_poses(Draw(1).pose(5))) {
    SCOPED_TRACE(name);
    EXPECT_EQ(closer_than(workspace, pair, {}, pose, 100), Answer::maybe);
    EXPECT_EQ(closer_than(workspace, pair, {}, pose, std::numeric_limits<double>::infinity()), Answer::maybe);
    TreePair other(cube, cube);
    EXPECT_EQ(collide_coherently(workspace, other, {}, away).answer, Answer::no);
    EXPECT_EQ(collide_coherently(workspace, other, {}, pose).answer, Answer::maybe);
    EXPECT_EQ(collide_coherently(workspace, other, {}, away).answer, Answer::no);
  }
}

// Copies of a tree change places with their poses, which a workspace that is asked about them again does not keep.
TEST(TreePair, AnswersAsANewOneWhereTheWorkspaceHasItsTreesAlready) {
  const auto all = bodies();
  const auto copies = bodies();
  const auto trees = prepared(all), others = prepared(copies);
  Workspace kept;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const PairCase c = random_case(all, seed);
    const PreparedTree& other = seed % 2 == 0 ? others[c.a] : trees[c.b];
    const TreePair pairs[] = {{trees[c.a], other}, {trees[c.a], other}, {other, trees[c.a]}};
    const Pose poses[][2] = {{c.at_a, c.at_b}, {c.at_b, c.at_a}, {c.at_a, c.at_b}};
    for (std::size_t i = 0; i < 3; ++i) {
      Workspace fresh;
      ASSERT_TRUE(same_verdict(collide(kept, pairs[i], poses[i][0], poses[i][1]),
                               collide(fresh, pairs[i], poses[i][0], poses[i][1])))
          << seed << " " << i;
    }
  }
}

// A body that wanders in and out of contact, now slowly, now in leaps.
TEST(Coherent, GivesTheAnswersOfFreshQueriesForLessWork) {
  const auto all = bodies();
  const auto trees = prepared(all);
  Workspace workspace, fresh;
  int yes = 0, no = 0, looked = 0, bounds = 0;
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 60 * orchard::test::more(); ++seed) {
    Draw draw(seed);
    const std::size_t i = draw.bits() % all.size(), j = draw.bits() % all.size();
    TreePair pair(trees[i], trees[j]);
    const double reach = all[i].tree.bounding_radius + all[j].tree.bounding_radius;
    const Pose a = centered(all[i].tree, draw.pose(0));
    Pose turned = draw.pose(0);
    const Vec way = draw.direction(), axis = draw.direction();
    const double speed = draw.uniform(0.001, 0.02), scale = seed % 4 == 0 ? 1.5 : 1;
    for (int step = 0; step < 80; ++step) {
      const double angle = 0.02;
      const Pose turn = *pose_from_quaternion({std::cos(angle / 2), std::sin(angle / 2) * axis[0],
                                               std::sin(angle / 2) * axis[1], std::sin(angle / 2) * axis[2]},
                                              {0, 0, 0});
      turned = compose(turn, turned);
      if (const auto rigid = made_rigid(turned)) turned = *rigid;
      const double at = reach * (0.9 * std::cos(step * speed * 5) + (step == 40 ? 0.2 : 0.0));
      Pose b = turned;
      b.scale = scale;
      b.translation = {at * way[0], at * way[1], at * way[2]};
      b = centered(all[j].tree, b);
      const Verdict again = collide_coherently(workspace, pair, a, b);
      const Verdict truth = collide(fresh, TreePair(trees[i], trees[j]), a, b);
      ASSERT_EQ(again.answer, truth.answer) << seed << " " << step;
      if (again.answer == Answer::no) {
        const Distance measured = distance(fresh, TreePair(trees[i], trees[j]), a, b);
        ASSERT_LE(again.lower_bound, measured.upper) << seed << " " << step;
        bounds += again.lower_bound > 0;
        if (orchard::test::more() > 1 && seed % 4 == 0 && step == 20) {
          const auto of_a = placed_triangles(all[i].tree, a), of_b = placed_triangles(all[j].tree, b);
          ASSERT_LE(again.lower_bound, surface_distance(of_a, of_b) * (1 + 1e-12L)) << seed;
        }
      }
      (again.answer == Answer::yes ? yes : no) += 1;
      looked += again.work > 0;
    }
  }
  EXPECT_GT(yes, 500);
  EXPECT_GT(no, 500);
  EXPECT_LT(looked, (yes + no) / 2);
  EXPECT_GT(bounds, no / 2);
}

// Jobs on threads of the test's own.
struct Pool {
  static void run(void*, std::size_t count, Executor::Job job, void* data) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([=] { job(data, i); });
    for (std::thread& thread : threads) thread.join();
  }
};

TEST(Batch, GivesTheSameAnswersOnEveryNumberOfThreads) {
  const auto all = bodies();
  const auto trees = prepared(all);
  std::vector<Pose> a, b;
  std::vector<TreePair> pairs;
  std::vector<Verdict> alone;
  Workspace single;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const PairCase c = random_case(all, seed);
    pairs.emplace_back(trees[c.a], trees[c.b]);
    a.push_back(c.at_a), b.push_back(c.at_b);
    alone.push_back(collide(single, pairs.back(), c.at_a, c.at_b));
  }
  std::vector<Distance> first;
  for (const std::size_t threads : {1u, 2u, 5u}) {
    std::vector<Workspace> workspaces(threads);
    const Executor executor{threads > 1 ? Pool::run : nullptr, nullptr, threads};
    std::vector<Verdict> verdicts(pairs.size());
    std::vector<Distance> distances(pairs.size());
    std::vector<Answer> near(pairs.size());
    share_among(executor, threads, pairs.size(), [&](std::size_t job, std::size_t i) {
      verdicts[i] = collide(workspaces[job], pairs[i], a[i], b[i]);
      distances[i] = distance(workspaces[job], pairs[i], a[i], b[i]);
      near[i] = closer_than(workspaces[job], pairs[i], a[i], b[i], 0.1);
    });
    if (first.empty()) first = distances;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      ASSERT_TRUE(same_verdict(verdicts[i], alone[i])) << i;
      ASSERT_EQ(distances[i].lower, first[i].lower) << i;
      ASSERT_EQ(distances[i].upper, first[i].upper) << i;
      ASSERT_EQ(near[i], closer_than(single, pairs[i], a[i], b[i], 0.1)) << i;
    }
  }
}

TEST(SelfCollision, LeavesOutWhatIsAllowedToTouch) {
  const auto link = build_tree(box({-1, -0.1, -0.1}, {1, 0.1, 0.1}));
  const std::vector<PreparedTree> parts(4, PreparedTree(link));
  SelfCollision arm(parts);
  Workspace workspace;
  std::vector<Pose> rest(4);
  for (int i = 0; i < 4; ++i) rest[static_cast<std::size_t>(i)].translation = {1.95 * i, 0, 0};  // neighbours overlap
  EXPECT_EQ(arm.first(workspace, rest).answer, Answer::yes);
  arm.allow_touching(workspace, rest);
  EXPECT_TRUE(arm.allows(1, 2));
  EXPECT_FALSE(arm.allows(0, 2));
  EXPECT_EQ(arm.first(workspace, rest).answer, Answer::no);
  std::vector<Pose> curled = rest;
  curled[3].translation = {0.5, 0.05, 0};
  const auto touch = arm.first(workspace, curled);
  EXPECT_EQ(touch.answer, Answer::yes);
  EXPECT_EQ(touch.part_a, 0u);
  EXPECT_EQ(touch.part_b, 3u);
  int all = 0;
  arm.each(workspace, curled, [&](const SelfCollision::Touch& t) {
    EXPECT_TRUE(t.part_b == 3 && t.part_a < 2);
    return ++all, true;
  });
  EXPECT_EQ(all, 2);
  for (std::size_t part = 0; part < parts.size(); ++part) arm.allow(3, part);
  EXPECT_EQ(arm.first(workspace, curled).answer, Answer::no);
}

}  // namespace
}  // namespace orchard::runtime
