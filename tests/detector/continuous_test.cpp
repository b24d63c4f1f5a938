#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "orchard/runtime/detector.h"
#include "support.h"
#include "support/effort.h"

// Bodies that are found between two steps.
namespace orchard::runtime {
namespace {

constexpr double kImpactStep = 0.02;

struct Shot {
  Frame frame;
  std::vector<PairEvent> events;
};

// A bullet that flies from one place to another within one step, and what it meets.
std::vector<PairEvent> shoot(const PackedSphereTree& target, const Pose& target_pose, double radius, const Vec3& from,
                             const Vec3& to, double speed, bool half_space = false) {
  std::vector<BodyState> states(4);
  Detector detector(states_of(states), {.time_step = kImpactStep, .watch = false});
  const ShapeId bullet = detector.add_sphere(radius), tree = detector.add_shape(target);
  const BodyId id = detector.add_body({{bullet, {}}}, {.continuous_speed = speed});
  if (half_space) {
    detector.add_half_space({0, 0, 1}, 0);
  } else {
    detector.add_static({{tree, {}}}, target_pose);
  }
  for (BodyState& state : states) state.expiry = 0;
  std::vector<PairEvent> events;
  const Vec3 places[] = {from, to, to + 10.0 * (to - from)};
  for (int step = 0; step < 3; ++step) {
    states[id.index].pose.translation = places[step];
    if (step == 2) detector.teleport(id);
    const Frame frame = detector.step(step * kImpactStep);
    events.insert(events.end(), frame.events.begin(), frame.events.end());
  }
  return events;
}

TEST(Continuous, ABulletDoesNotTunnelThroughAThinWall) {
  const PackedSphereTree wall = test::build_tree(test::box({-5, -5, -0.001}, {5, 5, 0.001}));
  const Vec3 from = {0.3, 0.2, 7}, to = {-0.4, 0.1, -9};
  const double speed = std::sqrt(dot(to - from, to - from)) / kImpactStep * 1.01;
  EXPECT_TRUE(shoot(wall, {}, 0.01, from, to, 0).empty());  // at the steps nothing is to be seen
  const auto events = shoot(wall, {}, 0.01, from, to, speed);
  ASSERT_EQ(events.size(), 2u);
  EXPECT_EQ(events[0].change, PairChange::begin);
  EXPECT_EQ(events[1].change, PairChange::end);
  // The ball's front is 0.011 above the middle of the wall at first.
  const double impact = kImpactStep * (7 - 0.011) / 16;
  EXPECT_LE(events[0].impact_from, impact + 1e-9);
  EXPECT_GE(events[0].impact_to, impact - 1e-9);
  EXPECT_NEAR(events[0].impact_from, impact, 1e-5);
  EXPECT_NEAR(events[0].impact_to, impact, 1e-5);
  EXPECT_NEAR(events[0].verdict.contact.center[2], 0.001, 1e-3);
}

TEST(Continuous, ABulletDoesNotTunnelThroughAHalfSpaceThatItLeavesAgain) {
  const auto events = shoot({}, {}, 0.1, {0, 0, 5}, {3, 0, -2}, 400, true);
  ASSERT_GE(events.size(), 1u);
  EXPECT_EQ(events[0].change, PairChange::begin);
  EXPECT_NEAR(events[0].impact_from, kImpactStep * 4.9 / 7, 1e-6);
}

// Random shots through random bodies against dense sampling.
TEST(Continuous, HitsWhereSamplingDoesAndMissesElsewhere) {
  const PackedSphereTree tree = test::build_tree(test::torus(14, 6, 1, 0.3));
  test::Draw draw(7);
  int hits = 0, misses = 0;
  for (int shot = 0; shot < 120; ++shot) {
    const Pose pose = draw.pose(draw.uniform(0, 1));
    const auto outside = [&] { return 4.0 * Vec3(draw.direction()); };
    const Vec3 from = outside(), to = -1.0 * from + 1.2 * Vec3(draw.direction());
    const double radius = draw.uniform(0.01, 0.2);
    const auto triangles = test::placed_triangles(tree, pose);
    long double least = 1e9L;
    constexpr int kSamples = 400;
    const double way = std::sqrt(dot(to - from, to - from));
    for (int i = 0; i <= kSamples; ++i) {
      const Vec3 at = from + (1.0 * i / kSamples) * (to - from);
      for (const auto& t : triangles) {
        least = std::min(least, test::point_distance({at[0], at[1], at[2]}, t) - static_cast<long double>(radius));
      }
    }
    const auto events = shoot(tree, pose, radius, from, to, way / kImpactStep * 1.01);
    const bool hit = !events.empty() && events[0].change == PairChange::begin;
    if (least <= 0) {
      EXPECT_TRUE(hit) << shot;
      ++hits;
    } else if (least > way / kSamples) {
      EXPECT_TRUE(events.empty()) << shot;
      ++misses;
    }
  }
  EXPECT_GT(hits, 30);
  EXPECT_GT(misses, 10);
}

// Two trees that spin through each other within one step, at whose ends they are apart.
TEST(Continuous, TreesThatTurnAreSweptAsWell) {
  const PackedSphereTree blade = test::build_tree(test::box({-2, -0.05, -0.05}, {2, 0.05, 0.05}));
  const PackedSphereTree post = test::build_tree(test::box({-0.1, -0.1, -1}, {0.1, 0.1, 1}));
  std::vector<BodyState> states(2);
  Detector detector(states_of(states), {.time_step = kImpactStep, .watch = false});
  const ShapeId shape = detector.add_shape(blade);
  const BodyId id = detector.add_body({{shape, {}}}, {.continuous_speed = 1});
  detector.add_static({{detector.add_shape(post), {}}}, {.translation = {1.5, 0, 0}});
  states[0].expiry = 0;
  const auto turned = [](double angle) {
    return *pose_from_quaternion({std::cos(angle / 2), 0, 0, std::sin(angle / 2)}, {});
  };
  states[id.index].pose = turned(-0.5);
  EXPECT_TRUE(detector.step(0).events.empty());
  states[id.index].pose = turned(0.5);
  const Frame frame = detector.step(kImpactStep);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::begin);
  EXPECT_GT(frame.events[0].impact_from, 0.5 * kImpactStep * 0.5);
  EXPECT_LT(frame.events[0].impact_to, 0.5 * kImpactStep);
  states[id.index].pose = turned(0.7);
  const Frame after = detector.step(2 * kImpactStep);
  ASSERT_EQ(after.events.size(), 1u);
  EXPECT_EQ(after.events[0].change, PairChange::end);
}

// The same motion, given by the body's pose or by a joint, meets the same at the same time.
TEST(Continuous, JointsThatMoveBetweenTwoStepsAreSweptLikeBodies) {
  const PackedSphereTree blade = test::build_tree(test::box({-2, -0.05, -0.05}, {2, 0.05, 0.05}));
  const PackedSphereTree post = test::build_tree(test::box({-0.1, -0.1, -1}, {0.1, 0.1, 1}));
  test::Draw draw(orchard::test::first_seed() + 61);
  const auto cases = static_cast<int>(100 * orchard::test::more());
  int hits = 0;
  for (int i = 0; i < cases; ++i) {
    const auto any_pose = [&] {
      const double angle = draw.uniform(-1.2, 1.2);
      return *pose_from_quaternion({std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
                                   {draw.uniform(-1.5, 1.5), draw.uniform(-1.5, 1.5), 0});
    };
    const Pose from = any_pose(), to = any_pose();
    const auto events_of = [&](bool by_joint, double speed) {
      std::vector<BodyState> states(2);
      Detector detector(states_of(states), {.time_step = kImpactStep, .watch = false});
      const BodyId id = detector.add_body({{detector.add_shape(blade), {}}}, {.continuous_speed = speed, .reach = 5});
      detector.add_static({{detector.add_shape(post), {}}}, {});
      states[id.index].expiry = 0;
      std::vector<PairEvent> events;
      int step = 0;
      for (const Pose& pose : {from, to, to}) {
        if (by_joint) {
          EXPECT_TRUE(detector.set_local(id, 0, {}));  // only what was so at the step counts
          EXPECT_TRUE(detector.set_local(id, 0, pose));
        } else {
          states[id.index].pose = pose;
        }
        const Frame frame = detector.step(step++ * kImpactStep);
        events.insert(events.end(), frame.events.begin(), frame.events.end());
      }
      return events;
    };
    const double speed = 5 / kImpactStep;
    const auto by_body = events_of(false, speed), by_joint = events_of(true, speed);
    ASSERT_EQ(by_joint.size(), by_body.size()) << i;
    for (std::size_t k = 0; k < by_body.size(); ++k) {
      ASSERT_EQ(by_joint[k].change, by_body[k].change) << i;
      ASSERT_EQ(std::isnan(by_joint[k].impact_to), std::isnan(by_body[k].impact_to)) << i;
      if (std::isnan(by_body[k].impact_to)) continue;
      ASSERT_NEAR(by_joint[k].impact_to, by_body[k].impact_to, 1e-4 * kImpactStep) << i;
    }
    if (by_joint.size() > events_of(true, 0).size()) ++hits;
  }
  EXPECT_GT(hits, cases / 50);  // that only the sweep can see
}

// What a joint takes farther out than ever, from where the detector was not looking: what was in between is not known.
TEST(Continuous, APartThatIsStretchedIntoTheUnknownIsPossible) {
  int asked = 0;
  const StateSource at_rest = [&](double, std::span<const BodyIndex> bodies, std::span<BodyState> states) {
    for (std::size_t i = 0; i < bodies.size(); ++i) states[i] = BodyState{};
    ++asked;
  };
  Detector detector(at_rest, {.time_step = kImpactStep, .watch = false});
  const BodyId id = detector.add_body({{detector.add_sphere(0.1), {}}}, {.continuous_speed = 1});
  detector.add_static({{detector.add_sphere(0.5), {}}}, {.translation = {0, 0, 3}});
  int step = 0;
  for (; step < 4; ++step) EXPECT_TRUE(detector.step(step * kImpactStep).events.empty());
  ASSERT_EQ(asked, 1);
  EXPECT_TRUE(detector.set_local(id, 0, {.translation = {0, 0, 6}}));
  const Frame frame = detector.step(step * kImpactStep);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::possible);
}

TEST(Continuous, ABudgetIsKeptAndWhatItLeavesOpenIsPossible) {
  const PackedSphereTree wall = test::build_tree(test::torus(30, 16, 1, 0.3));
  std::vector<BodyState> states(40);
  Detector detector(states_of(states), {.time_step = kImpactStep, .watch = false});
  const ShapeId shape = detector.add_shape(wall);
  detector.add_static({{shape, {}}}, {});
  std::vector<BodyId> ids(20);
  for (BodyId& id : ids) id = detector.add_body({{shape, {.scale = 0.05}}}, {.continuous_speed = 1e3});
  for (BodyState& state : states) state.expiry = 0;
  std::size_t possible = 0;
  for (const std::uint64_t work : {2000u, 4000u, 20'000u}) {
    for (int step = 0; step < 4; ++step) {
      for (std::size_t i = 0; i < ids.size(); ++i) {
        states[ids[i].index].pose.translation = {1 + 0.01 * static_cast<double>(i), 0.002 * static_cast<double>(i),
                                                 step % 2 == 0 ? 2.0 : -2.0};
      }
      static int time = 0;
      const Frame frame = detector.step(time++ * kImpactStep, {.work = work});
      EXPECT_LT(frame.work, work + kMaxOvershoot + 2 * kMotionWork);
      for (const PairEvent& event : frame.events) possible += event.change == PairChange::possible;
    }
  }
  EXPECT_GT(possible, 0u);
}

// Nothing was between a bullet and a body that has come since the step before, whatever its parts do: the answer is
// that of this step.
TEST(Continuous, ABodyThatIsNewNearABulletIsAnsweredForAtOnce) {
  std::size_t touches = 0;
  for (std::uint64_t i = 0; i < 100 * orchard::test::more(); ++i) {
    test::Draw draw(orchard::test::first_seed() + i);
    Detector world({.time_step = kImpactStep, .watch = false});
    const ShapeId ball = world.add_sphere(0.5);
    std::vector<std::pair<BodyId, double>> all;  // and where its ball is on the x axis
    const auto add = [&](double x, double off) {
      const BodyId id = world.add_body(ball, {.pose = {.translation = {x, 0, 0}}}, {.continuous_speed = 100});
      world.set_local(id, 0, {.translation = {off, 0, 0}});
      all.emplace_back(id, x + off);
    };
    for (int step = 0; step < 6; ++step) {
      add(draw.uniform(-4, 4), draw.uniform(-3, 3));
      std::set<std::pair<BodyIndex, BodyIndex>> found, truth;
      for (const PairEvent& event : world.step(step * kImpactStep).events) {
        ASSERT_NE(event.change, PairChange::possible) << i << " " << step;
        found.insert({event.a.index, event.b.index});
      }
      for (const auto& [a, x] : all) {
        for (const auto& [b, y] : all) {
          if (a.index < b.index && std::fabs(x - y) <= 1) truth.insert({a.index, b.index});
        }
      }
      ASSERT_EQ(found, truth) << i << " " << step;
      touches += truth.size();
    }
  }
  EXPECT_GT(touches, 100u);
}

}  // namespace
}  // namespace orchard::runtime
