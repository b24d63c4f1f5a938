#include <gtest/gtest.h>

#include <cmath>

#include "query_judge.h"
#include "runtime/numbers.h"

// Queries in worlds and with values that are not like others.
namespace orchard::runtime {
namespace {

using test::ask_everything;
using test::Judge;

using test::kInfinity;
using test::kNaN;
using test::kStep;

// Clusters, a body far away, sizes from points to more than the world: what the grid cannot hold.
TEST(QueryCases, FindWhatTheGridCannotHold) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    test::Draw draw(seed);
    std::vector<Motion> values(600);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Vec3 home = i % 3 == 0 ? Vec3{} : i % 3 == 1 ? Vec3{1e4, 0, 0} : draw.in_ball(1e5);
      values[i].position = home + draw.in_ball(6);
      values[i].radius = std::pow(10, draw.uniform(-3, seed % 2 == 0 ? 0 : 3));
    }
    values[7].position = {1e30, -1e30, 1e30};
    values[8].radius = 1e60;
    values[9].position = {-1e99, 0, 0};
    values[9].radius = 1e99;
    BroadPhase world(values_of(values), {.time_step = kStep});
    for (std::size_t i = 0; i < values.size(); ++i) world.add();
    BodyQueries queries(world);
    const Judge judge(queries, values.size(), [&](BodyIndex i) { return &values[i]; });
    for (int step = 0; step < 3; ++step) {
      world.advance(kStep * step);
      for (const double ball : {1.0, 10.0, 1e4, 1e6}) {
        for (int k = 0; k < 10; ++k) ask_everything(judge, draw, ball);
        if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed << " ball " << ball;
      }
      const Vec3 far = {1e30, -1e30, 1e30};
      judge.sphere(far, 0);
      judge.ray({far, {-1, 1, -1}, kInfinity});
      judge.segment(far, {});
      judge.nearest(far, 3);
      judge.box({-1e100, -1e100, -1e100}, {1e100, 1e100, 1e100});
    }
  }
}

TEST(QueryCases, RefuseWhatMakesNoSense) {
  std::vector<Motion> values(1);
  values[0].radius = 1;
  BroadPhase world(values_of(values), {.time_step = kStep});
  BodyQueries queries(world);
  EXPECT_FALSE(queries.first_hit({{5, 0, 0}, {-1, 0, 0}}));  // of an empty world
  EXPECT_FALSE(queries.refused());
  EXPECT_TRUE(queries.nearest({}, 3).empty());
  EXPECT_TRUE(queries.touching_sphere({}, 1e6).empty());
  EXPECT_FALSE(queries.refused());
  world.add();
  for (const bool moved : {false, true}) {
    if (moved) world.advance(0);
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e101}) {
      for (std::size_t d = 0; d < 3; ++d) {
        Vec3 v = {1, 1, 1};
        v[d] = bad;
        EXPECT_TRUE(!queries.first_hit({v, {1, 0, 0}}) && queries.refused());
        EXPECT_TRUE(queries.all_hits({{}, v}).empty() && queries.refused());
        EXPECT_TRUE(!queries.first_on_segment(v, {}) && queries.refused());
        EXPECT_TRUE(queries.all_on_segment({}, v).empty() && queries.refused());
        EXPECT_TRUE(queries.touching_sphere(v, 1).empty() && queries.refused());
        EXPECT_TRUE(queries.touching_box(v, {2, 2, 2}).empty() && queries.refused());
        EXPECT_TRUE(queries.touching_box({-2, -2, -2}, v).empty() && queries.refused());
        EXPECT_TRUE(queries.nearest(v, 1).empty() && queries.refused());
      }
      EXPECT_TRUE(queries.touching_sphere({}, bad).empty() && queries.refused());
    }
    EXPECT_TRUE(queries.touching_sphere({}, -1e-300).empty() && queries.refused());
    EXPECT_TRUE(!queries.first_hit({{}, {0, -0.0, 0}}) && queries.refused());
    EXPECT_TRUE(!queries.first_hit({{}, {1, 0, 0}, -1}) && queries.refused());
    EXPECT_TRUE(!queries.first_hit({{}, {1, 0, 0}, kNaN}) && queries.refused());
    EXPECT_TRUE(queries.touching_box({1, 0, 0}, {0.9, 1, 1}).empty() && queries.refused());
    EXPECT_TRUE(queries.nearest({}, 0).empty() && !queries.refused());
    EXPECT_EQ(queries.nearest({}, 1000).size(), 1u);  // there are no more
    const auto hit = queries.first_hit({{5, 0, 0}, {-2, 0, 0}});
    ASSERT_TRUE(hit && !queries.refused());
    EXPECT_EQ(hit->along, 2);
    EXPECT_EQ(queries.first_hit({{5, 0, 0}, {-2, 0, 0}, 2})->body, 0u);  // closed
    EXPECT_FALSE(queries.first_hit({{5, 0, 0}, {-2, 0, 0}, 1.999}));
    EXPECT_EQ(queries.first_hit({{0, 1, 0}, {0, 1, 0}})->along, 0);  // it begins on the sphere
    EXPECT_EQ(queries.first_on_segment({0, 0.5, 0}, {0, 0.5, 0})->along, 0);
    EXPECT_EQ(queries.first_on_segment({0, 3, 0}, {0, 1, 0})->along, 1);
    EXPECT_EQ(queries.touching_sphere({3, 0, 0}, 2).size(), 1u);
    EXPECT_EQ(queries.touching_box({1, -1, -1}, {2, 1, 1}).size(), 1u);
    EXPECT_EQ(queries.nearest({3, 0, 0}, 1)[0].distance, 2);
  }
  BroadPhase invalid(values_of(values), {.time_step = -1});
  BodyQueries none(invalid);
  EXPECT_TRUE(!none.first_hit({{}, {1, 0, 0}}) && none.refused());
  EXPECT_TRUE(none.nearest({}, 1).empty() && none.refused());
}

TEST(QueryCases, PreferTheSmallerIndexAmongEquals) {
  for (const std::size_t n : {6u, 400u}) {
    std::vector<Motion> values(n);
    for (std::size_t i = 0; i < n; ++i) {
      values[i].position = {i < 6 ? 0.0 : 10.0 * static_cast<double>(i), 0, 0};
      values[i].radius = 1;
    }
    BroadPhase world(values_of(values), {.time_step = kStep});
    for (std::size_t i = 0; i < n; ++i) world.add();
    world.advance(0);
    BodyQueries queries(world);
    EXPECT_EQ(queries.first_hit({{0, 5, 0}, {0, -1, 0}})->body, 0u);
    const auto near = queries.nearest({0, 5, 0}, 3);
    ASSERT_EQ(near.size(), 3u);
    for (BodyIndex i = 0; i < 3; ++i) EXPECT_EQ(near[i].body, i);
    EXPECT_EQ(queries.nearest({0, 0.5, 0}, 2)[1].body, 1u);  // inside of all
    EXPECT_EQ(queries.nearest({0, 0.5, 0}, 2)[1].distance, 0);
  }
}

// What a query costs does not grow with the world.
TEST(QueryCases, AskFewBodies) {
  const test::MovingBodies bodies({.bodies = 8000, .ball = 40, .min_radius = 0.1, .max_radius = 0.4}, 1);
  BroadPhase world(bodies.source(), {.time_step = kStep});
  for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
  for (int step = 0; step < 30; ++step) world.advance(kStep * step);
  BodyQueries queries(world);
  test::Draw draw(2);
  const std::uint64_t before = world.motions_asked();
  for (int i = 0; i < 100; ++i) {
    queries.first_hit({draw.in_ball(40), draw.direction()});
    queries.touching_sphere(draw.in_ball(40), 1);
    queries.touching_box(draw.in_ball(30), {40, 40, 40});
    queries.nearest(draw.in_ball(40), 4);
  }
  const double per_round = static_cast<double>(world.motions_asked() - before) / 100;
  EXPECT_LT(per_round, 2500);  // most of it for the boxes, which are large
  const std::uint64_t again = world.motions_asked();
  for (int i = 0; i < 100; ++i) {
    queries.first_hit({draw.in_ball(40), draw.direction()});
    queries.touching_sphere(draw.in_ball(40), 1);
    queries.nearest(draw.in_ball(40), 4);
  }
  EXPECT_LT(static_cast<double>(world.motions_asked() - again) / 100, 300);
}

}  // namespace
}  // namespace orchard::runtime
