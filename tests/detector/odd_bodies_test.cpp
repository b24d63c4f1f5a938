#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "orchard/runtime/detector.h"
#include "orchard/runtime/flexible_tree.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/shape_query.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

// What bodies do that scenes do not: they wake in flight, are huge or next to nothing, break their promises for a
// moment, or are handed over wrong.
namespace orchard::runtime {
namespace {

using test::Draw;

using test::kNaN;

Pose at(double x, double y = 0, double z = 0) {
  Pose pose;
  pose.translation = {x, y, z};
  return pose;
}

using test::kStep;
using test::time_at;

TEST(OddBodies, AreNeverPairsOfThemselvesOrOfWhatIsGone) {
  for (const double drift : {1e3, 1e9, 1e12}) {
    std::vector<BodyState> states(3);
    for (std::size_t i = 0; i < 3; ++i) states[i].pose = at(30.0 * static_cast<double>(i));
    std::set<BodyIndex> asked;
    Detector world(
        [&](double, std::span<const BodyIndex> bodies, std::span<BodyState> answers) {
          for (std::size_t i = 0; i < bodies.size(); ++i) asked.insert(bodies[i]), answers[i] = states[bodies[i]];
        },
        {.time_step = kStep, .watch = false});
    const ShapeId ball = world.add_sphere(1);
    std::array<BodyId, 3> ids{};
    for (BodyId& id : ids) id = world.add_body({{ball}});
    world.step(0);
    world.remove(ids[0]);
    states[1].drift = drift;
    world.cancel(ids[1]);
    asked.clear();
    for (int k = 1; k < 4; ++k) EXPECT_TRUE(world.step(time_at(k)).events.empty()) << drift;
    EXPECT_FALSE(asked.contains(0)) << drift;
  }
}

TEST(OddBodies, AreMetOnTheWayInTheStepInWhichTheyWake) {
  for (const int who : {0, 1, 2, 3}) {  // none sleeps, the bullet, the wall, the bullet until its state is set
    Detector world({.time_step = kStep, .watch = false});
    const ShapeId ball = world.add_sphere(0.05), plate = world.add_box({0.01, 1, 1});
    const BodyId bullet = world.add_body(ball, BodyState{.pose = at(-0.3)}, {.continuous_speed = 100});
    const BodyId wall = world.add_body(plate, BodyState{});
    world.step(0);
    if (who == 1 || who == 3) world.sleep(bullet);
    if (who == 2) world.sleep(wall);
    for (int k = 1; k < 6; ++k) world.step(time_at(k));
    if (who == 1) world.wake(bullet);
    if (who == 2) world.wake(wall);
    if (who == 3) {
      world.set_state(bullet, {.pose = at(0.3)});
    } else {
      world.set_velocity(bullet, {60, 0, 0});
    }
    const Frame frame = world.step(time_at(6));
    ASSERT_EQ(frame.events.size(), 1u) << who;
    EXPECT_EQ(frame.events[0].verdict.answer, Answer::yes) << who;
    EXPECT_GT(frame.events[0].impact_from, time_at(5)) << who;
  }
}

struct TwoThatTouch {
  std::vector<BodyState> states{BodyState{}, BodyState{.pose = at(0.5)}};
  Detector world{states_of(states), {.time_step = kStep, .watch = false, .steps_to_end = 3}};
  BodyId first;
  TwoThatTouch() {
    const ShapeId ball = world.add_sphere(1);
    first = world.add_body({{ball}});
    world.add_body({{ball}});
  }
};

TEST(OddBodies, TouchNoMoreOnceTeleportedHoweverLongATouchLasts) {
  TwoThatTouch two;
  auto& [states, world, first] = two;
  ASSERT_EQ(world.step(0).events.size(), 1u);
  world.teleport(first);
  states[0].pose = at(100);
  const Frame frame = world.step(time_at(1));
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::end);
}

TEST(OddBodies, TouchAgainOnceTheirStatesAreValidAgain) {
  TwoThatTouch two;
  auto& [states, world, first] = two;
  world.step(0);
  states[0].velocity = {kNaN, 0, 0};
  world.cancel(first);
  EXPECT_EQ(world.step(time_at(1)).refused.size(), 1u);
  states[0].velocity = {};
  for (int k = 2; k < 8; ++k) {
    const Frame frame = world.step(time_at(k));
    ASSERT_EQ(frame.events.size(), 1u);
    EXPECT_EQ(frame.events[0].verdict.answer, Answer::yes) << k;
  }
}

TEST(OddBodies, AreSolidWhereverFlexibleTreesHaveGone) {
  const std::vector<std::array<double, 3>> rest = {{0, 0, 0}, {.1, 0, 0}, {0, .1, 0}, {0, 0, .1}};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const PackedSphereTree tree = triangles_tree(rest, triangles);
  FlexibleTree flexible(tree, 3.0);
  Detector world({.time_step = kStep, .watch = false});
  const ShapeId bag = world.add_shape(flexible.view()), box = world.add_box({.5, .5, .5});
  world.add_body(bag, BodyState{});
  world.add_body(box, BodyState{.pose = at(1)});
  EXPECT_TRUE(world.step(0).events.empty());
  const std::vector<std::uint32_t> vertices = {0, 1, 2, 3};
  auto moved = rest;
  for (auto& point : moved) point[0] += 0.95;
  ASSERT_TRUE(flexible.move(vertices, moved));
  world.shape_changed(bag);
  ASSERT_EQ(world.step(time_at(1)).events.size(), 1u);  // wholly inside
  ASSERT_TRUE(flexible.move(vertices, rest));
  world.shape_changed(bag);
  const Frame frame = world.step(time_at(2));
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::end);
}

TEST(OddBodies, AreAsFarOffAsTheSlackSays) {
  constexpr double slack = 0.01;
  for (const bool watch : {false, true}) {
    std::vector<BodyState> states(1);
    states[0].pose = at(0, 0, 1.005 + slack);
    Detector world(states_of(states), {.time_step = kStep, .position_slack = slack, .watch = watch});
    world.add_body({{world.add_sphere(1)}});
    world.add_half_space({0, 0, 1}, 0);
    world.step(0);
    states[0].pose = at(0, 0, 1.005 - slack);
    for (int k = 1; k < 20; ++k) {
      const Frame frame = world.step(time_at(k));
      EXPECT_EQ(frame.events.size(), 1u) << watch << k;
      EXPECT_TRUE(frame.broken.empty()) << k;
    }
  }
}

TEST(OddBodies, KeepWhatIsSuggestedForThemAboveAHalfSpace) {
  for (const bool above : {false, true}) {
    std::vector<BodyState> states(1);
    states[0].pose = at(0, 0, 1000);
    Detector world(states_of(states), {.time_step = kStep, .watch = true});
    world.add_body({{world.add_sphere(1)}}, {.suggest = true});
    if (above) world.add_half_space({0, 0, 1}, 0);
    std::size_t broken = 0;
    for (int k = 0; k < 400; ++k) {
      states[0].pose = at(0, 0, 1000 - 5 * time_at(k) * time_at(k));
      broken += world.step(time_at(k)).broken.size();
    }
    EXPECT_LT(broken, 10u) << above;
  }
}

TEST(OddBodies, AreLeftAloneByWhatIsRefused) {
  Detector world({.time_step = kStep, .watch = false});
  const ShapeId ball = world.add_sphere(1);
  const BodyId fixed = world.add_static({{ball}, {ball}}, at(0));
  const BodyId free = world.add_body(ball, BodyState{.pose = at(50)});
  world.step(0);
  EXPECT_FALSE(world.set_local(fixed, 1, at(1e150)));
  EXPECT_TRUE(world.set_local(fixed, 1, at(50)));
  EXPECT_EQ(world.step(time_at(1)).events.size(), 1u);
  EXPECT_FALSE(world.set_velocity(free, {kNaN, 0, 0}));
  EXPECT_FALSE(world.set_state(free, {.pose = {.scale = 0}}));
  EXPECT_FALSE(world.set_state(free, {.acceleration = -1}));
  EXPECT_EQ(world.add_body(ball, BodyState{.acceleration = -1}), kNoBody);
  EXPECT_EQ(world.add_half_space({0, 0, 1}, 0, {.continuous_speed = kNaN}), kNoBody);
  EXPECT_EQ(world.step(time_at(2)).events.size(), 1u);
  EXPECT_EQ(world.state(free).pose.translation, at(50).translation);
}

TEST(OddBodies, AreSweptWhicheverOfTwoIsContinuous) {
  std::vector<BodyState> states(1);
  states[0].pose = at(-0.4), states[0].velocity = {60, 0, 0};
  Detector world(states_of(states), {.time_step = kStep, .watch = false});
  world.add_body({{world.add_sphere(0.05)}});
  world.add_static({{world.add_box({0.01, 1, 1})}}, at(0), {.continuous_speed = 100});
  world.step(0);
  states[0].pose = at(0.2);
  EXPECT_EQ(world.step(time_at(1)).events.size(), 1u);
}

TEST(OddBodies, AreMissedNeitherForTheirSizeNorForANormals) {
  for (const double unit : {1e-10, 1e-20, 1e-23}) {
    Detector world({.time_step = kStep, .watch = false});
    const ShapeId ball = world.add_sphere(1.95 * unit);
    world.add_body(ball, BodyState{});
    world.add_body(ball, BodyState{.pose = at(2.6 * unit, 2.6 * unit)});
    EXPECT_EQ(world.step(0).events.size(), 1u) << unit;
  }
  for (const double size : {1.0, 1e-160, 3e-162, 1e-170, 1e160}) {
    for (const double height : {0.96, 0.998, 1.003, 1.04}) {
      Detector world({.time_step = kStep, .watch = false});
      world.add_body(world.add_sphere(1), BodyState{.pose = at(100 + height)});
      ASSERT_NE(world.add_half_space({size, 0, 0}, 100 * size), kNoBody) << size;
      EXPECT_EQ(world.step(0).events.size(), height < 1 ? 1u : 0u) << size << ' ' << height;
    }
  }
}

TEST(OddBodies, OfNoThicknessMeetTheBoxesThatTheyPierce) {
  Draw draw(8 + orchard::test::first_seed());
  for (std::uint64_t i = 0; i < 300 * orchard::test::more(); ++i) {
    const Vec3 way = draw.direction();
    const Vec3 middle = draw.uniform(0, 0.35) * Vec3(draw.direction());
    for (const double radius : {0.0, 1e-17, 1e-12}) {
      Detector world({.time_step = kStep, .watch = false});
      const ShapeId line = world.add_capsule(middle - 2.0 * way, middle + 2.0 * way, radius);
      const ShapeId box = world.add_box({0.5, 0.5, i % 4 == 0 ? 0 : 0.5});
      if (i % 4 == 0 && std::fabs(way[2]) < 0.9) continue;  // else it may pass beside what is flat
      world.add_body(line, BodyState{});
      world.add_body(box, BodyState{});
      ASSERT_EQ(world.step(0).events.size(), 1u) << i << ' ' << radius;
    }
  }
}

// The solver's question: how far apart do they have to go.
TEST(OddBodies, TouchNoMoreOnceMovedByTheirDepth) {
  Draw draw(9 + orchard::test::first_seed());
  int asked = 0;
  for (std::uint64_t i = 0; i < 400 * orchard::test::more(); ++i) {
    for (const int kind : {0, 1}) {
      const bool boxes = kind == 0;
      const std::array<double, 3> half = {0.5, 0.4, 0.6};
      const PackedSphereTree tree = box_tree(half);
      const Pose place = draw.pose(0.6);
      const auto world_of = [&](Detector& world, double depth, const Vec3& normal) {
        const ShapeId solid = boxes ? world.add_box(half) : world.add_shape(tree);
        world.add_body(solid, BodyState{});
        Pose moved = place;
        moved.translation = Vec3(place.translation) + depth * normal;
        world.add_body(world.add_capsule({-0.4, 0, 0}, {0.3, 0, 0}, 0.2), BodyState{.pose = moved});
      };
      Detector world({.time_step = kStep, .watch = false});
      world_of(world, 0, {});
      const Frame frame = world.step(0);
      if (frame.events.empty()) continue;
      const Manifold manifold = world.manifold(frame.events[0]);
      if (manifold.count == 0) continue;
      ++asked;
      Detector apart({.time_step = kStep, .watch = false});
      world_of(apart, manifold.depth + 1e-9, manifold.normal);
      EXPECT_TRUE(apart.step(0).events.empty()) << i << ' ' << kind << ' ' << manifold.depth;
      if (manifold.depth < 1e-6) continue;
      Detector still({.time_step = kStep, .watch = false});
      world_of(still, manifold.depth - 1e-7, manifold.normal);
      EXPECT_EQ(still.step(0).events.size(), 1u) << i << ' ' << kind << ' ' << manifold.depth;
    }
  }
  EXPECT_GT(asked, 100);
}

TEST(OddBodies, InReusedSlotsHaveBrokenNothing) {
  std::vector<BodyState> states(1);
  Detector world(states_of(states), {.time_step = kStep, .watch = true});
  const ShapeId ball = world.add_sphere(1);
  const BodyId first = world.add_body({{ball}});
  for (int k = 0; k < 6; ++k) states[0].pose = at(k), world.step(time_at(k));
  EXPECT_GT(world.motion_bound_violations(first), 0u);
  world.remove(first);
  EXPECT_EQ(world.motion_bound_violations(world.add_body({{ball}})), 0u);
  EXPECT_GT(world.motion_bound_violations(), 0u);
}

TEST(OddBodies, OfManyPartsStayWithinABudget) {
  for (const int parts : {4, 8, 32}) {
    std::vector<BodyState> states(1);
    states[0].pose = at(-0.3), states[0].drift = 1000;
    Detector world(states_of(states), {.time_step = 1, .watch = false});
    const ShapeId ball = world.add_sphere(0.05), plate = world.add_box({0.01, .3, .3});
    std::vector<BodyPart> balls, plates;
    for (int i = 0; i < parts; ++i) balls.push_back({ball, at(0, .001 * i)}), plates.push_back({plate, at(0.001 * i)});
    world.add_body(balls, {.continuous_speed = 100});
    world.add_static(plates, {});
    world.step(0);
    states[0].pose = at(-.25);
    EXPECT_LT(world.step(1, {.work = 1000}).work, 1000 + kMaxOvershoot) << parts;
  }
}

}  // namespace
}  // namespace orchard::runtime
