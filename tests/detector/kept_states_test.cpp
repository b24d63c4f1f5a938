#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>

#include "orchard/runtime/detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

// Detectors that keep the states of their bodies.
namespace orchard::runtime {
namespace {

using test::kStep;

struct KeptBall {
  BodyId id;
  Vec3 place{}, velocity{};
  double radius = 0, since = 0;
  Vec3 at(double time) const { return place + (time - since) * velocity; }
};

// Balls that change their ways at any step, against their distances in closed form.
void play(std::uint64_t seed, bool watch) {
  test::Draw draw(seed);
  Detector world({.time_step = kStep, .watch = watch});
  std::vector<KeptBall> balls(12);
  const auto anywhere = [&](double size) {
    return Vec3{draw.uniform(-size, size), draw.uniform(-size, size), draw.uniform(-size, size)};
  };
  for (KeptBall& ball : balls) {
    ball.place = anywhere(3), ball.velocity = anywhere(20), ball.radius = draw.uniform(0.2, 0.8);
    const ShapeId shape = world.add_sphere(ball.radius);
    EXPECT_EQ(world.reach(shape), ball.radius * (1 + 1e-15) * (1 + 1e-15));
    ball.id = world.add_body(shape, {.pose = {.translation = ball.place}, .velocity = ball.velocity});
  }
  std::size_t touches = 0;
  for (int step = 0; step < 60; ++step) {
    const double time = step * kStep;
    std::set<std::pair<BodyIndex, BodyIndex>> found;
    for (const PairEvent& event : world.step(time).events) {
      if (event.change != PairChange::end) found.insert({event.a.index, event.b.index});
    }
    for (std::size_t i = 0; i < balls.size(); ++i) {
      for (std::size_t j = i + 1; j < balls.size(); ++j) {
        const Vec3 way = balls[j].at(time) - balls[i].at(time);
        const double gap = std::sqrt(dot(way, way)) - balls[i].radius - balls[j].radius;
        if (std::fabs(gap) < 1e-9) continue;
        const auto pair = std::minmax(balls[i].id.index, balls[j].id.index);
        ASSERT_EQ(found.count(pair), gap < 0 ? 1u : 0u) << "seed " << seed << ", step " << step << ", gap " << gap;
        touches += gap < 0;
      }
    }
    for (KeptBall& ball : balls) {
      const Vec3 place = world.state(ball.id).pose.translation;
      for (std::size_t d = 0; d < 3; ++d) ASSERT_NEAR(place[d], ball.at(time)[d], 1e-12);
      if (draw.uniform(0, 1) > 0.1) continue;
      const bool jumps = draw.uniform(0, 1) < 0.5;
      ball.place = jumps ? anywhere(3) : ball.at(time), ball.since = time;
      ball.velocity = anywhere(20);
      if (jumps) {
        EXPECT_TRUE(world.set_state(ball.id, {.pose = {.translation = ball.place}, .velocity = ball.velocity}));
      } else {
        EXPECT_TRUE(world.set_velocity(ball.id, ball.velocity));
      }
    }
  }
  EXPECT_GT(touches, 0u);
  EXPECT_EQ(world.motion_bound_violations() > 0, watch);
}

TEST(KeptStates, AreWhatBodiesMoveBy) {
  for (std::uint64_t i = 0; i < 20 * orchard::test::more(); ++i) {
    play(orchard::test::first_seed() + i, i % 2 != 0);
  }
}

TEST(KeptStates, AreThoseOfBodiesThatMove) {
  Detector world;
  const ShapeId ball = world.add_sphere(1);
  const BodyId a = world.add_body(ball, {.velocity = {1, 0, 0}});
  const BodyId wall = world.add_half_space({0, 0, 1}, -50);
  const BodyId rock = world.add_static({{ball}}, {.translation = {0, 9, 0}});
  EXPECT_TRUE(world.moves(a));
  for (const BodyId id : {wall, rock, kNoBody}) {
    EXPECT_FALSE(world.moves(id));
    EXPECT_FALSE(world.set_state(id, {}));
    EXPECT_FALSE(world.set_velocity(id, {1, 0, 0}));
    EXPECT_EQ(world.state(id).velocity, (Vec3{}));
  }
  EXPECT_EQ(world.state(rock).pose.translation[1], 9);
  world.step(0.5);
  EXPECT_NEAR(world.state(a).pose.translation[0], 0.5, 1e-12);
  EXPECT_TRUE(world.remove(a));
  EXPECT_FALSE(world.set_state(a, {}));
  const BodyId next = world.add_body({{ball}});  // with the same index, and at rest until it is told otherwise
  EXPECT_EQ(next.index, a.index);
  world.step(1);
  EXPECT_EQ(world.state(next).pose, Pose{});
  std::vector<BodyState> states(4);
  Detector with_source(states_of(states));
  EXPECT_EQ(with_source.add_body(with_source.add_sphere(1), BodyState{}), kNoBody);
  EXPECT_FALSE(with_source.set_state(with_source.add_body({{0}}), {}));
  EXPECT_EQ(world.add_body(kNoShape, BodyState{}), kNoBody);
}

// It sleeps on at the new place.
TEST(KeptStates, MoveABodyThatSleeps) {
  Detector world;
  const ShapeId ball = world.add_sphere(1);
  const BodyId a = world.add_body(ball, {}), b = world.add_body(ball, {.pose = {.translation = {9, 0, 0}}});
  EXPECT_TRUE(world.sleep(b));
  EXPECT_TRUE(world.step(0).events.empty());
  EXPECT_TRUE(world.step(0.01).events.empty());
  EXPECT_TRUE(world.set_state(b, {.pose = {.translation = {1.5, 0, 0}}, .velocity = {100, 0, 0}}));
  ASSERT_EQ(world.step(0.02).events.size(), 1u);
  EXPECT_TRUE(world.asleep(b));
  EXPECT_TRUE(world.set_velocity(a, {-100, 0, 0}));
  EXPECT_TRUE(world.step(0.03).events.size() == 1);
  EXPECT_TRUE(world.sleep(a));  // it stops where it is
  EXPECT_TRUE(world.step(0.05).events.empty());
  EXPECT_EQ(world.state(a).velocity, (Vec3{}));
  EXPECT_NEAR(world.state(a).pose.translation[0], -1, 1e-12);
  EXPECT_TRUE(world.wake(b));
  EXPECT_TRUE(world.set_state(b, {.pose = {.translation = {3, 0, 0}}, .velocity = {-100, 0, 0}}));
  EXPECT_EQ(world.step(0.07).events.size(), 1u);
  EXPECT_NEAR(world.state(b).pose.translation[0], 1, 1e-12);
}

TEST(LoadedShapes, AreThoseOfTheFile) {
  const PackedSphereTree torus = test::build_tree(test::torus(12, 6, 0.75, 0.25));
  const auto bytes = serialize(torus);
  const std::string path = testing::TempDir() + "orchard_loaded_shape.orchard";
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  Detector world;
  LoadStatus status{};
  EXPECT_EQ(world.load_shape("no such file", &status), kNoShape);
  EXPECT_EQ(status, LoadStatus::cannot_open);
  const ShapeId loaded = world.load_shape(path.c_str(), &status), added = world.add_shape(torus);
  std::filesystem::remove(path);
  ASSERT_NE(loaded, kNoShape);
  EXPECT_EQ(status, LoadStatus::ok);
  EXPECT_EQ(world.reach(loaded), world.reach(added));
  EXPECT_EQ(world.reach(99), 0);
  const BodyId a = world.add_body(loaded, {});
  world.add_body(loaded, {.pose = {.translation = {1.9, 0, 0}}});
  world.add_body(added, {.pose = {.translation = {-1.9, 0, 0}}});
  const Frame frame = world.step(0);
  ASSERT_EQ(frame.events.size(), 2u);
  EXPECT_EQ(frame.events[0].a, a);
  EXPECT_EQ(frame.events[0].verdict.answer, Answer::yes);
  EXPECT_EQ(frame.events[1].verdict.answer, Answer::yes);
}

}  // namespace
}  // namespace orchard::runtime
