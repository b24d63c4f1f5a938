#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "orchard/runtime/detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

// Bodies whose origin is not in their middle, and how fast they turn.
namespace orchard::runtime {
namespace {

using test::Draw;

using test::kInfinity;
using test::kStep;
using test::time_at;

Pose turned(const Vec3& axis, double angle, const Vec3& place) {
  const double s = std::sin(angle / 2);
  return *pose_from_quaternion({std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]}, place);
}

// A ball that is 3 off its body's origin, and what the broad phase is told of it.
struct Hammer {
  std::vector<BodyState> states = std::vector<BodyState>(8);
  std::vector<Motion> told;
  Detector world;
  ShapeId ball, head;

  explicit Hammer(bool watch = false)
      : world(states_of(states), {.time_step = kStep,
                                  .watch = watch,
                                  .bound_given =
                                      [this](double, BodyIndex body, const Motion& motion) {
                                        if (body == 0) told.push_back(motion);
                                      }}),
        ball(world.add_sphere(1)),
        head(world.add_sphere(1, {3, 0, 0})) {}
  const Motion& last() const { return told.back(); }
};

TEST(Turning, IsPromisedSoThatTheSphereIsNoLargerThanTheBody) {
  for (const double angular_speed : {0.0, 0.5, 1e3, kInfinity}) {
    Hammer hammer;
    hammer.states[0].pose.translation = {1, 2, 3};
    hammer.states[0].pose.scale = 2;
    hammer.states[0].drift = 0.25;
    hammer.states[0].angular_speed = angular_speed;
    hammer.world.add_body({{hammer.head}});
    hammer.world.step(0);
    const Motion& told = hammer.last();
    if (angular_speed < 1) {
      EXPECT_NEAR(told.radius, 2, 1e-9);
      EXPECT_EQ(told.position, (Vec3{7, 2, 3}));
      EXPECT_NEAR(told.drift, 0.25 + angular_speed * 6, 1e-7);
      EXPECT_GE(told.drift, 0.25 + angular_speed * 6);
    } else {  // it may be anywhere around its origin soon
      EXPECT_NEAR(told.radius, 8, 1e-9);
      EXPECT_EQ(told.position, (Vec3{1, 2, 3}));
      EXPECT_EQ(told.drift, 0.25);
    }
  }
}

TEST(Turning, IsKnownOfStatesThatTheDetectorKeeps) {
  std::vector<Motion> told;
  Detector world(DetectorOptions{
      .time_step = kStep, .bound_given = [&](double, BodyIndex, const Motion& motion) { told.push_back(motion); }});
  const ShapeId head = world.add_sphere(1, {3, 0, 0});
  const BodyId id = world.add_body(head, BodyState{});
  world.step(0);
  ASSERT_FALSE(told.empty());
  EXPECT_NEAR(told.back().radius, 1, 1e-9);
  EXPECT_EQ(world.state(id).angular_speed, kInfinity);  // as it was told
  const BodyId wall = world.add_static({{world.add_sphere(0.5)}}, turned({0, 0, 1}, 0, {0, 3, 0}));
  ASSERT_NE(wall, kNoBody);
  for (int k = 1; k <= 40; ++k) {  // until the head is where the wall is
    world.set_state(id, BodyState{.pose = turned({0, 0, 1}, k * std::acos(-1.0) / 80, {})});
    EXPECT_EQ(world.step(time_at(k)).events.empty(),
              k * std::acos(-1.0) / 80 < std::acos(-1.0) / 2 - 2 * std::asin(0.25));
  }
}

TEST(Turning, ThatIsNoSpeedIsRefused) {
  for (const double wrong : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Hammer hammer;
    hammer.world.add_body({{hammer.head}});
    hammer.world.add_body({{hammer.ball}});
    hammer.states[0].angular_speed = wrong;
    hammer.states[1].pose.translation = {3, 0, 0};
    EXPECT_EQ(hammer.world.step(0).refused.size(), 1u) << wrong;
    hammer.states[0].angular_speed = 0;
    EXPECT_EQ(hammer.world.step(time_at(1)).events.size(), 1u) << wrong;
    Detector keeps(DetectorOptions{.time_step = kStep});
    EXPECT_EQ(keeps.add_body(keeps.add_sphere(1), BodyState{.angular_speed = wrong}), kNoBody);
  }
}

TEST(Turning, FasterThanPromisedIsTold) {
  Hammer hammer(true);
  const BodyId id = hammer.world.add_body({{hammer.head}});
  hammer.world.add_static({{hammer.ball}}, turned({0, 0, 1}, 0, {0, 3, 0}));
  hammer.states[0].angular_speed = 0.1;
  std::size_t broken = 0, touching = 0;
  for (int k = 0; k <= 40; ++k) {
    const double angle = k < 20 ? 1e-3 * k : 0.01 + std::min(1.6, 0.3 * (k - 20));
    hammer.states[0].pose = turned({0, 0, 1}, angle, {});
    const Frame frame = hammer.world.step(time_at(k));
    broken += frame.broken.size();
    EXPECT_TRUE(k >= 20 || broken == 0) << k;
    touching += !frame.events.empty();
  }
  EXPECT_GE(broken, 1u);
  EXPECT_EQ(hammer.world.motion_bound_violations(id), broken);
  EXPECT_GE(touching, 10u);
}

TEST(Turning, MayBePromisedNowAndThen) {  // the middle one step, the origin the next: nothing of that is broken
  for (const bool watch : {false, true}) {
    Hammer hammer(watch);
    hammer.world.add_body({{hammer.head}});
    hammer.world.add_half_space({1, 0, 0}, -6);
    for (int k = 0; k < 60; ++k) {
      hammer.states[0].pose = turned({0, 0, 1}, 0.01 * k, {0, 0.02 * k, 0});
      hammer.states[0].velocity = {0, 2, 0};
      hammer.states[0].angular_speed = k % 3 == 0 ? kInfinity : 1.0;
      hammer.states[0].expiry = time_at(k + k % 4);
      EXPECT_TRUE(hammer.world.step(time_at(k)).broken.empty()) << watch << k;
    }
  }
}

// What is told later takes nothing back of what was promised.
TEST(Turning, IsWatchedWhateverIsPromisedNext) {
  for (const double next : {1.0, 1e99, 1e101, kInfinity}) {
    Hammer hammer(true);
    hammer.world.add_body({{hammer.head}});
    hammer.world.add_static({{hammer.ball}}, turned({0, 0, 1}, 0, {0, 3, 0}));
    hammer.states[0].angular_speed = 0;
    std::size_t broken = 0, touching = 0;
    for (int k = 0; k <= 200; ++k) {
      hammer.states[0].pose = turned({0, 0, 1}, 0.01 * k, {});
      const Frame frame = hammer.world.step(time_at(k));
      hammer.states[0].angular_speed = next;
      broken += frame.broken.size();
      const double angle = std::fabs(0.01 * k - std::acos(-1.0) / 2), reach = 2 * std::asin(1.0 / 3);
      if (std::fabs(angle - reach) < 1e-9) continue;
      EXPECT_EQ(frame.events.empty(), angle > reach) << next << ' ' << k;
      touching += !frame.events.empty();
    }
    EXPECT_GE(broken, 1u) << next;
    EXPECT_GT(touching, 50u) << next;
  }
}

TEST(Turning, ThatIsNoSpeedIsRefusedAtOnceWhereItIsWatched) {
  for (const bool place : {false, true}) {  // or that is no velocity
    Hammer hammer(true);
    hammer.world.add_body({{hammer.ball}});
    hammer.world.add_body({{hammer.ball}});
    hammer.states[1].pose.translation = {50, 0, 0};
    EXPECT_TRUE(hammer.world.step(0).refused.empty());
    if (place) hammer.states[0].velocity = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    if (!place) hammer.states[0].angular_speed = -1;
    hammer.states[0].pose.translation = {49, 0, 0};
    for (int k = 1; k < 4; ++k) EXPECT_EQ(hammer.world.step(time_at(k)).refused.size(), 1u) << place << k;
    hammer.states[0].velocity = {};
    hammer.states[0].angular_speed = 1;
    EXPECT_EQ(hammer.world.step(time_at(4)).events.size(), 1u) << place;
  }
}

TEST(OddStates, AreRefusedThoughAnEarlierPromiseHoldsOn) {  // and what touches may do so
  for (const bool touching : {false, true}) {
    Hammer hammer;
    hammer.world.add_body({{hammer.ball}});
    hammer.world.add_body({{hammer.ball}});
    hammer.states[1].pose.translation = {touching ? 1.0 : 1.95, 0, 0};
    EXPECT_EQ(hammer.world.step(0).events.size(), 1u);
    hammer.states[0].velocity = {0, std::numeric_limits<double>::quiet_NaN(), 0};
    const Frame frame = hammer.world.step(time_at(1));
    ASSERT_EQ(frame.refused.size(), 1u);
    EXPECT_EQ(frame.refused[0], 0u);
    ASSERT_EQ(frame.events.size(), 1u);
    EXPECT_EQ(frame.events[0].verdict.answer, Answer::maybe);
    hammer.states[0].velocity = {};
    const Frame next = hammer.world.step(time_at(2));
    EXPECT_TRUE(next.refused.empty());
    ASSERT_EQ(next.events.size(), 1u);
    EXPECT_EQ(next.events[0].verdict.answer, Answer::yes);
  }
}

TEST(Turning, PromisesOfMiddlesNearTheWorldsOriginAreKept) {
  Draw draw(orchard::test::first_seed());
  for (int i = 0; i < 200; ++i) {
    const Vec3 arm = draw.uniform(100, 1000) * Vec3(draw.direction());
    Detector world({.time_step = kStep, .watch = true});
    const ShapeId head = world.add_sphere(1, arm);
    const Vec3 way = draw.uniform(0, 1) * Vec3(draw.direction());
    BodyState state;
    state.pose = turned(draw.direction(), draw.uniform(0, 3), {});
    state.pose.translation = -1.0 * Vec3(rotate(state.pose, arm)) - 0.5 * way;
    state.velocity = way;
    state.angular_speed = 0;
    ASSERT_NE(world.add_body(head, state), kNoBody);
    for (int k = 0; k < 100; ++k) EXPECT_TRUE(world.step(time_at(k)).broken.empty()) << i << ' ' << k;
  }
}

TEST(Turning, OfPartsThatMoveIsNoPromise) {
  for (const bool at_rest : {false, true}) {  // static
    Hammer hammer;
    const std::array<BodyPart, 2> parts = {{{hammer.head}, {hammer.ball, turned({0, 0, 1}, 0, {4, 0, 0})}}};
    const BodyId id = at_rest ? hammer.world.add_static(parts, Pose{}) : hammer.world.add_body(parts);
    const BodyId other = hammer.world.add_body({{hammer.ball}});
    hammer.states[0].angular_speed = 0;
    hammer.states[other.index].pose.translation = {-3, 0, 0};
    EXPECT_TRUE(hammer.world.step(0).events.empty());
    ASSERT_TRUE(hammer.world.set_local(id, 1, turned({0, 0, 1}, 0, {-3, 0, 0})));
    EXPECT_EQ(hammer.world.step(time_at(1)).events.size(), 1u) << at_rest;
    const Vec3 origin = {0, 0, 0};
    EXPECT_TRUE(at_rest || hammer.last().position == origin);
  }
}

TEST(Turning, IsNoPromiseOnceThereAreBullets) {
  Hammer hammer;
  hammer.states[0].angular_speed = 0;
  hammer.world.add_body({{hammer.head}});
  hammer.world.step(0);
  EXPECT_NEAR(hammer.last().radius, 1, 1e-9);
  hammer.world.add_body({{hammer.ball}}, {.continuous_speed = 1});
  hammer.states[1].pose.translation = {0, 0, 20};
  hammer.world.step(time_at(1));
  EXPECT_NEAR(hammer.last().radius, 4, 1e-9);
}

// Balls off their bodies' origins, some of them static or on one body, that turn as they promise: brute force knows.
struct Ball {
  Vec3 middle;
  double radius;
};

struct Body {
  std::vector<Ball> balls;
  Vec3 axis{}, place{}, velocity{};
  double spin = 0, margin = 1;  // promised: so many times as fast
  int horizon = 0;              // of promises, in steps; below 0: it promises nothing of how it turns
  bool is_static = false;
  Pose at(int step) const {
    const double t = is_static ? 0 : time_at(step);
    return turned(axis, spin * t, place + t * velocity);
  }
};

Body random_body(Draw& draw) {
  Body body;
  const double off = draw.uniform(0, 4);
  const int count = 1 + static_cast<int>(draw.uniform(0, 4)) % 4;
  const Vec3 middle = off * Vec3(draw.direction());
  for (int i = 0; i < count; ++i) {
    body.balls.push_back({middle + draw.uniform(0, 0.5) * Vec3(draw.direction()), draw.uniform(0.1, 0.4)});
  }
  body.axis = draw.direction();
  body.place = draw.uniform(0, 4) * Vec3(draw.direction());
  body.velocity = draw.uniform(0, 4) * Vec3(draw.direction());
  body.spin = draw.uniform(-12, 12);
  body.margin = draw.uniform(1, 2);
  body.horizon = static_cast<int>(draw.uniform(-3, 12));
  body.is_static = draw.uniform(0, 1) < 0.2;
  return body;
}

double gap(const Body& a, const Body& b, int step) {
  double least = kInfinity;
  for (const Ball& p : a.balls) {
    for (const Ball& q : b.balls) {
      const Vec3 way = Vec3(transform(a.at(step), p.middle)) - Vec3(transform(b.at(step), q.middle));
      least = std::min(least, std::sqrt(dot(way, way)) - p.radius - q.radius);
    }
  }
  return least;
}

TEST(Turning, AsPromisedMissesNoBody) {
  constexpr int kSteps = 40;
  constexpr std::size_t kBodies = 14;
  std::size_t touching = 0, apart = 0;
  const std::uint64_t first = orchard::test::first_seed(), count = 40 * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    Draw draw(seed);
    std::vector<Body> bodies;
    std::vector<BodyState> states(kBodies);
    const bool watch = draw.uniform(0, 1) < 0.3;
    Detector world(states_of(states), {.time_step = kStep, .watch = watch});
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < kBodies; ++i) {
      bodies.push_back(random_body(draw));
      std::vector<BodyPart> parts;
      for (const Ball& ball : bodies[i].balls) parts.push_back({world.add_sphere(ball.radius, ball.middle)});
      ids.push_back(bodies[i].is_static ? world.add_static(parts, bodies[i].at(0)) : world.add_body(parts));
      ASSERT_EQ(ids[i].index, i);
    }
    for (int step = 0; step < kSteps; ++step) {
      for (std::size_t i = 0; i < kBodies; ++i) {
        const Body& body = bodies[i];
        states[i].pose = body.at(step);
        states[i].velocity = body.velocity;
        states[i].angular_speed = body.horizon < 0 ? kInfinity : std::fabs(body.spin) * body.margin;
        states[i].expiry = time_at(step + std::abs(body.horizon));
      }
      const Frame frame = world.step(time_at(step));
      EXPECT_TRUE(frame.broken.empty()) << seed << ' ' << step;
      std::set<std::pair<BodyIndex, BodyIndex>> found;
      for (const PairEvent& event : frame.events) {
        if (event.verdict.answer == Answer::yes) found.insert({event.a.index, event.b.index});
      }
      for (BodyIndex i = 0; i < kBodies; ++i) {
        for (BodyIndex j = i + 1; j < kBodies; ++j) {
          if (bodies[i].is_static && bodies[j].is_static) continue;
          const double distance = gap(bodies[i], bodies[j], step);
          if (std::fabs(distance) < 1e-9) continue;
          EXPECT_EQ(found.contains({i, j}), distance < 0) << seed << ' ' << step << ' ' << i << ' ' << j;
          ++(distance < 0 ? touching : apart);
        }
      }
    }
  }
  EXPECT_GT(touching, 500u);
  EXPECT_GT(apart, 10000u);
}

}  // namespace
}  // namespace orchard::runtime
