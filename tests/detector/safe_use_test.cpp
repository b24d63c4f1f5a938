#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "orchard/runtime/detector.h"
#include "orchard/runtime/orchard_detector.h"
#include "runtime/numbers.h"
#include "support.h"
#include "support/effort.h"

// What goes right with the defaults, and is refused where it cannot: for programs written from the headers alone.
namespace orchard::runtime {
namespace {

using test::kStep;
using Pairs = std::set<std::pair<BodyIndex, BodyIndex>>;

// Balls and one box that a solver of the application's own moves, each judged in long double.
class Solver {
 public:
  explicit Solver(std::uint64_t seed) : draw_(seed) {}

  void add(BodyId id, double radius) {
    bodies_.push_back({id, {}, {}, radius});
    Ball& ball = bodies_.back();
    for (std::size_t d = 0; d < 3; ++d) ball.place[d] = draw_.uniform(-4, 4), ball.velocity[d] = draw_.uniform(-9, 9);
    ball.place[2] += 5;
  }
  // Gravity, a floor that the balls bounce from, and a push now and then.
  void move() {
    for (Ball& ball : bodies_) {
      ball.velocity[2] -= 9.81 * kStep;
      if (draw_.uniform(0, 1) < 0.02) ball.velocity[0] = draw_.uniform(-20, 20);
      ball.place = ball.place + kStep * ball.velocity;
      if (ball.place[2] < ball.radius) ball.place[2] = ball.radius, ball.velocity[2] = std::fabs(ball.velocity[2]);
    }
  }
  void put_into(std::vector<BodyState>& states) const {
    for (const Ball& ball : bodies_) {
      states[ball.id.index].pose.translation = ball.place;
      states[ball.id.index].velocity = ball.velocity;
    }
  }
  // Those that touch; `unsure`: nearer to it than rounding tells.
  Pairs touching(BodyIndex box, const Vec3& half, Pairs& unsure) const {
    Pairs found;
    const auto judge = [&](BodyIndex a, BodyIndex b, long double gap) {
      if (std::fabs(gap) < 1e-9L) unsure.insert(std::minmax(a, b));
      if (gap <= 0) found.insert(std::minmax(a, b));
    };
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      long double square = 0;
      for (std::size_t d = 0; d < 3; ++d) {
        const long double beyond = std::max(0.0L, std::fabs(static_cast<long double>(bodies_[i].place[d])) - half[d]);
        square += beyond * beyond;
      }
      judge(bodies_[i].id.index, box, std::sqrt(square) - bodies_[i].radius);
      for (std::size_t j = i + 1; j < bodies_.size(); ++j) {
        long double between = 0;
        for (std::size_t d = 0; d < 3; ++d) {
          const long double x = static_cast<long double>(bodies_[i].place[d]) - bodies_[j].place[d];
          between += x * x;
        }
        judge(bodies_[i].id.index, bodies_[j].id.index, std::sqrt(between) - bodies_[i].radius - bodies_[j].radius);
      }
    }
    return found;
  }
  std::size_t size() const { return bodies_.size(); }

 private:
  struct Ball {
    BodyId id;
    Vec3 place, velocity;
    double radius;
  };
  test::Draw draw_;
  std::vector<Ball> bodies_;
};

Pairs touching(const Frame& frame) {
  Pairs found;
  for (const PairEvent& event : frame.events) {
    if (event.change == PairChange::end) {
      found.erase({event.a.index, event.b.index});
    } else {
      found.insert({event.a.index, event.b.index});
    }
  }
  return found;
}

void expect_alike(const Pairs& found, const Pairs& truth, const Pairs& unsure, const std::string& where) {
  Pairs differ;
  std::set_symmetric_difference(found.begin(), found.end(), truth.begin(), truth.end(),
                                std::inserter(differ, differ.begin()));
  for (const auto& pair : differ) ASSERT_TRUE(unsure.count(pair) != 0) << where << ": " << pair.first << pair.second;
}

const Vec3 kHalf = {3, 2.5, 0.7};

// Only pose and velocity are filled in, and what is not promised is found all the same.
std::size_t play_with_defaults(std::uint64_t seed) {
  std::vector<BodyState> states(12);
  Detector world(states_of(states));
  Solver solver(seed);
  const BodyId box = world.add_static({{world.add_box(kHalf)}}, {});
  for (int i = 0; i < 10; ++i) {
    const double radius = 0.2 + 0.05 * i;
    solver.add(world.add_body({{world.add_sphere(radius)}}), radius);
  }
  std::size_t touches = 0;
  for (int step = 0; step < 60; ++step) {
    solver.put_into(states);
    Pairs unsure;
    const Pairs truth = solver.touching(box.index, kHalf, unsure);
    expect_alike(touching(world.step(step * kStep)), truth, unsure, "seed " + std::to_string(seed));
    touches += truth.size();
    solver.move();
  }
  return touches;
}

TEST(Defaults, MissNothingOfBodiesThatASolverMovesByPoseAndVelocityAlone) {
  std::size_t touches = 0;
  for (std::uint64_t i = 0; i < 30 * orchard::test::more(); ++i)
    touches += play_with_defaults(orchard::test::first_seed() + i);
  EXPECT_GT(touches, 100u);
}

TEST(Defaults, WatchWithASourceAndNotWithout) {
  std::vector<BodyState> states(2);
  Detector watching(states_of(states));
  const BodyOptions guesses{.suggest = true};
  EXPECT_NE(watching.add_body({{watching.add_sphere(1)}}), kNoBody);
  EXPECT_NE(watching.add_body({{0}}, guesses), kNoBody);
  watching.step(0);
  states[0].pose.translation = {3, 0, 0};
  EXPECT_EQ(watching.step(kStep).broken.size(), 1u);

  Detector trusting(states_of(states), {.watch = false});
  const ShapeId ball = trusting.add_sphere(1);
  EXPECT_EQ(trusting.add_body({{ball}}, guesses), kNoBody);
  EXPECT_EQ(trusting.add_body({{ball}}), (BodyId{0, 1}));
  trusting.step(0);
  states[0].pose.translation = {9, 0, 0};
  EXPECT_TRUE(trusting.step(kStep).broken.empty());

  Detector keeping;
  const ShapeId kept = keeping.add_sphere(1);
  EXPECT_EQ(keeping.add_body({{kept}}, guesses), kNoBody);
  const BodyId moved = keeping.add_body(kept, BodyState{});
  keeping.step(0);
  keeping.set_velocity(moved, {1, 0, 0});
  EXPECT_TRUE(keeping.step(kStep).broken.empty());
}

struct CWorld {
  std::vector<orchard_body_state> states = std::vector<orchard_body_state>(4, orchard_default_state());
  static void source(void* context, double, const uint32_t* bodies, size_t count, orchard_body_state* states) {
    for (size_t i = 0; i < count; ++i) states[i] = static_cast<CWorld*>(context)->states[bodies[i]];
  }
};

TEST(Defaults, AreThoseOfNullOptionsInC) {
  CWorld c;
  orchard_detector* const world = orchard_detector_new(&CWorld::source, &c, nullptr);
  ASSERT_NE(world, nullptr);
  const double center[3] = {0, 0, 0}, half[3] = {5, 5, 0.5}, normal[3] = {0, 0, 1};
  const orchard_part ball = {orchard_detector_add_sphere(world, 0.5, center), orchard_identity()};
  const orchard_part box = {orchard_detector_add_box(world, half), orchard_identity()};
  const orchard_pose there = orchard_identity();
  const orchard_body body = orchard_detector_add_body(world, &ball, 1, nullptr);
  EXPECT_NE(orchard_detector_add_static(world, &box, 1, &there, nullptr).index, ORCHARD_NO_BODY);
  EXPECT_NE(orchard_detector_add_half_space(world, normal, -50, nullptr).index, ORCHARD_NO_BODY);
  std::size_t begun = 0;
  for (int step = 0; step < 200; ++step) {  // falls, as its velocity does not say
    const double time = step * kStep;
    c.states[body.index].pose.translation[2] = 5 - 5 * time * time;
    const orchard_frame frame = orchard_detector_step(world, time, {ORCHARD_NO_LIMIT, ORCHARD_NO_LIMIT});
    for (size_t i = 0; i < frame.events; ++i) begun += orchard_detector_event(world, i).change == ORCHARD_BEGIN;
  }
  EXPECT_EQ(begun, 1u);
  orchard_detector_free(world);
  orchard_broad_phase* const broad = orchard_broad_phase_new(nullptr, nullptr, nullptr);
  ASSERT_NE(broad, nullptr);
  EXPECT_EQ(orchard_broad_phase_valid(broad), 1);
  orchard_broad_phase_free(broad);
}

// Bodies whose values the vector does not have, as static ones have come first, or between.
TEST(StatesOf, RefusesBodiesBeyondTheEndOfItsVector) {
  for (std::uint64_t i = 0; i < 200 * orchard::test::more(); ++i) {
    test::Draw draw(orchard::test::first_seed() + i);
    std::vector<BodyState> states(1 + draw.bits() % 12);
    const auto at_end = states.size();  // of memory, too
    states.shrink_to_fit();
    Detector world(states_of(states), {.watch = i % 2 != 0});
    const ShapeId ball = world.add_sphere(1);
    std::vector<BodyIndex> beyond;
    for (int k = 0; k < 12; ++k) {
      if (draw.uniform(0, 1) < 0.4) {
        world.add_static({{ball}}, {.translation = {5.0 * k, 50, 0}});
      } else if (const BodyIndex body = world.add_body({{ball}}).index; body >= at_end) {
        beyond.push_back(body);
      } else {
        states[body].pose.translation = {5.0 * k, 0, 0};
      }
    }
    const Frame frame = world.step(0);
    ASSERT_TRUE(std::equal(frame.refused.begin(), frame.refused.end(), beyond.begin(), beyond.end())) << i;
    ASSERT_TRUE(frame.events.empty());
  }
}

// Everything that can be asked of a detector, from within the source, the filter and the listener.
struct Meddler {
  Detector* world = nullptr;
  BodyId body;
  PairEvent event;
  int calls = 0;

  void meddle() {
    ++calls;
    const Pose pose;
    EXPECT_EQ(world->add_sphere(1), kNoShape);
    EXPECT_EQ(world->add_box({1, 1, 1}), kNoShape);
    EXPECT_EQ(world->add_shape(test::build_tree(test::box({-1, -1, -1}, {1, 1, 1}))), kNoShape);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(world->add_body({{0}}), kNoBody);
    EXPECT_EQ(world->add_body(0, BodyState{}), kNoBody);
    EXPECT_EQ(world->add_static({{0}}, pose), kNoBody);
    EXPECT_EQ(world->add_half_space({0, 0, 1}, 0), kNoBody);
    EXPECT_FALSE(world->remove(body) || world->cancel(body) || world->teleport(body) || world->move_static(body, pose));
    EXPECT_FALSE(world->set_state(body, {}) || world->set_velocity(body, {}) || world->set_local(body, 0, pose));
    EXPECT_FALSE(world->set_importance(body, 1) || world->set_filter(body, {.mask = 1}));
    EXPECT_FALSE(world->sleep(body) || world->wake(body) || world->shape_changed(0));
    world->set_pair_filter([](BodyId, BodyId) { return false; });
    world->set_executor({});
    EXPECT_TRUE(world->step(1e3).time_refused);
    EXPECT_EQ(world->manifold(event).answer, Answer::maybe);
    StepLoad load;
    EXPECT_EQ(world->predict_load({&load, 1}), 0u);
    EXPECT_TRUE(world->contains(body));
  }
};

TEST(CallsFromWithinAStep, AreRefusedAndChangeNothing) {
  for (std::uint64_t i = 0; i < 20 * orchard::test::more(); ++i) {
    const std::uint64_t seed = orchard::test::first_seed() + i;
    Meddler meddler;
    std::vector<BodyState> states(10), same(10);
    const StateSource plain = states_of(states);
    DetectorOptions options;
    options.watch = i % 2 == 0;
    DetectorOptions meddling = options;
    meddling.bound_given = [&](double, BodyIndex, const Motion&) { meddler.meddle(); };
    Detector world(
        [&](double time, std::span<const BodyIndex> bodies, std::span<BodyState> answers) {
          meddler.meddle();
          plain(time, bodies, answers);
        },
        meddling);
    Detector quiet(states_of(states), options);
    test::Draw draw(seed);
    for (Detector* each : {&world, &quiet}) {
      const ShapeId ball = each->add_sphere(1), box = each->add_box({1, 1, 1});
      for (int k = 0; k < 5; ++k) each->add_body({{ball}}), each->add_body({{box}});
    }
    world.set_pair_filter([&](BodyId, BodyId) { return meddler.meddle(), true; });
    meddler.world = &world, meddler.body = {0, 1};
    for (int step = 0; step < 5; ++step) {
      for (BodyState& state : states) {
        state = {.pose = draw.pose(2), .expiry = 0};
      }
      const Frame frame = world.step(step * kStep), other = quiet.step(step * kStep);
      ASSERT_EQ(frame.events.size(), other.events.size());
      for (std::size_t e = 0; e < frame.events.size(); ++e) {
        ASSERT_EQ(frame.events[e].change, other.events[e].change);
        ASSERT_EQ(frame.events[e].a, other.events[e].a);
        ASSERT_EQ(frame.events[e].b, other.events[e].b);
      }
      if (!frame.events.empty()) meddler.event = frame.events[0];
    }
    ASSERT_GT(meddler.calls, 0);
    EXPECT_EQ(world.size(), 10u);
    EXPECT_TRUE(world.remove({0, 1}));
  }
}

}  // namespace
}  // namespace orchard::runtime
