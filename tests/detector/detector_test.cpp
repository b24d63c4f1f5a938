// One world, made by the same few helpers, and all that can be asked of it: hence more than 300 lines.
#include "orchard/runtime/detector.h"

#include <gtest/gtest.h>

#include <cmath>

#include "runtime/allocation.h"
#include "runtime/numbers.h"
#include "support.h"

// What the header of the detector says about bodies, shapes and events, one by one.
namespace orchard::runtime {
namespace {

using test::kStep;

// A detector with states that the test writes.
struct WrittenWorld {
  std::vector<BodyState> states = std::vector<BodyState>(64);
  PackedSphereTree torus = test::build_tree(test::torus(12, 6, 0.75, 0.25));
  Detector detector;
  int steps = 0;

  explicit WrittenWorld(const DetectorOptions& options = {}) : detector(make(options)) {}
  Detector make(DetectorOptions options) {
    options.time_step = kStep;
    options.watch = options.watch.value_or(false);
    for (BodyState& state : states) state.expiry = 0;  // asked for at every step
    return Detector(states_of(states), options);
  }
  void put(BodyId body, const Vec3& place, double scale = 1) {
    states[body.index].pose.translation = place;
    states[body.index].pose.scale = scale;
  }
  Frame step(const Budget& budget = {}) { return detector.step(kStep * steps++, budget); }
  // Of the only event.
  PairEvent only(const Budget& budget = {}) {
    const Frame frame = step(budget);
    EXPECT_EQ(frame.events.size(), 1u);
    return frame.events.empty() ? PairEvent{} : frame.events[0];
  }
  bool silent() { return step().events.empty(); }
};

TEST(DetectorShapes, AreRefusedWhereTheyMakeNoSense) {
  WrittenWorld w;
  PackedSphereTree broken = w.torus;
  broken.blocks[0].link[0] = 0x7fffffff;
  EXPECT_EQ(w.detector.add_shape(broken), kNoShape);
  EXPECT_EQ(w.detector.add_sphere(-1), kNoShape);
  EXPECT_EQ(w.detector.add_sphere(NAN), kNoShape);
  EXPECT_EQ(w.detector.add_capsule({0, 0, 0}, {INFINITY, 0, 0}, 1), kNoShape);
  EXPECT_EQ(w.detector.add_box({1, -1, 1}), kNoShape);
  EXPECT_EQ(w.detector.add_box({1, NAN, 1}), kNoShape);
  EXPECT_EQ(w.detector.add_half_space({0, 0, 0}, 1), kNoBody);
  EXPECT_EQ(w.detector.add_half_space({0, 0, NAN}, 1), kNoBody);
  EXPECT_EQ(w.detector.add_sphere(1), 0u);
}

TEST(DetectorBodies, TellWhatTheBroadPhaseReliesOn) {
  std::vector<std::pair<double, Motion>> told;
  DetectorOptions options;
  options.bound_given = [&](double time, BodyIndex, const Motion& bound) { told.push_back({time, bound}); };
  WrittenWorld w(options);
  const BodyId body = w.detector.add_body({{w.detector.add_sphere(2)}});
  w.states[body.index].acceleration = 3;
  w.states[body.index].expiry = INFINITY;
  std::uint64_t asked = 0;
  for (int step = 0; step < 4; ++step) asked += w.step().motions_asked;
  ASSERT_EQ(told.size(), asked);
  EXPECT_EQ(told[0].first, 0);
  EXPECT_EQ(told[0].second.acceleration, 3);
  EXPECT_NEAR(told[0].second.radius, 2, 1e-9);
  w.detector.cancel(body);
  w.step();
  ASSERT_EQ(told.size(), asked + 1);
  EXPECT_EQ(told.back().first, 4 * kStep);
}

TEST(DetectorBodies, AreRefusedWhereTheyMakeNoSense) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  EXPECT_EQ(w.detector.add_body(std::span<const BodyPart>{}), kNoBody);
  EXPECT_EQ(w.detector.add_body({{ball + 1, {}}}), kNoBody);
  Pose mirror;
  mirror.rotation = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(w.detector.add_body({{ball, mirror}}), kNoBody);
  EXPECT_EQ(w.detector.add_static({{ball, {}}}, mirror), kNoBody);
  EXPECT_EQ(w.detector.add_body({{ball, {}}}, {.continuous_speed = -1}), kNoBody);
  EXPECT_EQ(w.detector.size(), 0u);
  const BodyId body = w.detector.add_body({{ball, {}}});
  EXPECT_TRUE(w.detector.contains(body));
  EXPECT_TRUE(w.detector.remove(body));
  for (const bool done :
       {w.detector.remove(body), w.detector.cancel(body), w.detector.teleport(body), w.detector.sleep(body),
        w.detector.wake(body), w.detector.set_importance(body, 1), w.detector.set_filter(body, {.mask = 1}),
        w.detector.set_local(body, 0, {}), w.detector.move_static(body, {})}) {
    EXPECT_FALSE(done);
  }
}

TEST(DetectorBodies, OptionsAndTimesThatMakeNoSenseAreRefused) {
  Detector detector(nullptr, {.time_step = -1});
  EXPECT_FALSE(detector.valid());
  EXPECT_EQ(detector.add_sphere(1), 0u);
  EXPECT_EQ(detector.add_static({{0, {}}}, {}), kNoBody);
  EXPECT_TRUE(detector.step(0).time_refused);
  WrittenWorld w;
  EXPECT_TRUE(w.detector.step(NAN).time_refused);
  EXPECT_TRUE(w.detector.step(1e300).time_refused);
  EXPECT_FALSE(w.step().time_refused);
}

// Every kind of shape against every other, just touching and just not: a quarter of a per mille makes the difference.
TEST(DetectorShapes, OfEveryKindTouchWhereTheyMeet) {
  struct Kind {
    const char* name;
    double half;  // along x
  };
  const Kind kinds[] = {{"sphere", 0.5}, {"capsule", 1.5}, {"box", 0.25}, {"tree", 1.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (const double off : {-2.5e-4, 2.5e-4}) {
        WrittenWorld w;
        const ShapeId shapes[] = {w.detector.add_sphere(0.5), w.detector.add_capsule({-1, 0, 0}, {1, 0, 0}, 0.5),
                                  w.detector.add_box({0.25, 1, 1}), w.detector.add_shape(w.torus)};
        const BodyId a = w.detector.add_body({{shapes[i], {}}}), b = w.detector.add_body({{shapes[j], {}}});
        w.put(a, {0, 0, 0});
        w.put(b, {kinds[i].half + kinds[j].half + off, 0, 0});
        const Frame frame = w.step();
        EXPECT_EQ(frame.events.size(), off < 0 ? 1u : 0u) << kinds[i].name << " and " << kinds[j].name;
        if (frame.events.empty()) continue;
        EXPECT_EQ(frame.events[0].change, PairChange::begin);
        EXPECT_NEAR(frame.events[0].verdict.contact.center[0], kinds[i].half, 1e-3);
        if (i >= 2 && j >= 2) continue;  // where triangles meet edge on, their normals say little
        EXPECT_GT(frame.events[0].verdict.contact.normal[0], 0.5) << kinds[i].name << " and " << kinds[j].name;
      }
    }
  }
}

TEST(DetectorShapes, OfEveryKindTouchAHalfSpaceWhereTheyMeetIt) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (const double off : {-2.5e-4, 2.5e-4}) {
      WrittenWorld w;
      const ShapeId shapes[] = {w.detector.add_sphere(0.5), w.detector.add_capsule({-1, 0, 0}, {1, 0, 0}, 0.5),
                                w.detector.add_box({0.25, 1, 1}), w.detector.add_shape(w.torus)};
      const double half[] = {0.5, 1.5, 0.25, 1.0};
      const BodyId floor = w.detector.add_half_space({3, 0, 0}, 6);  // x <= 2
      const BodyId body = w.detector.add_body({{shapes[i], {}}});
      w.put(body, {2 + half[i] + off, 0, 0});
      const Frame frame = w.step();
      ASSERT_EQ(frame.events.size(), off < 0 ? 1u : 0u) << i;
      if (frame.events.empty()) continue;
      EXPECT_EQ(frame.events[0].a, body);
      EXPECT_EQ(frame.events[0].b, floor);
      EXPECT_NEAR(frame.events[0].verdict.contact.center[0], 2, 1e-3);
      EXPECT_EQ(frame.events[0].verdict.contact.normal[0], -1);
      EXPECT_TRUE(w.detector.remove(floor));
      EXPECT_EQ(w.only().change, PairChange::end);
    }
  }
}

// By `depth` along the normal they come apart, and by a little less they do not.
TEST(DetectorShapes, OfEveryKindComeApartAsTheManifoldSays) {
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 5; ++j) {
      WrittenWorld w;
      const ShapeId shapes[] = {w.detector.add_sphere(0.5), w.detector.add_capsule({-1, 0, 0}, {1, 0, 0}, 0.5),
                                w.detector.add_box({0.25, 1, 1}), w.detector.add_shape(w.torus)};
      const double half[] = {0.5, 1.5, 0.25, 1.0};
      const BodyId a = w.detector.add_body({{shapes[i], {}}});
      BodyId b;
      w.put(a, {0, 0, 0});
      if (j == 4) {
        b = w.detector.add_half_space({1, 0, 0}, 0.05 - half[i]);
      } else {
        b = w.detector.add_body({{shapes[j], {}}});
        w.put(b, {half[i] + half[j] - 0.05, 0.011, 0.017});
      }
      const PairEvent event = w.only();
      const Manifold manifold = w.detector.manifold(event);
      ASSERT_EQ(manifold.answer, Answer::yes) << i << j;
      EXPECT_GE(manifold.count, 1u);
      EXPECT_GT(manifold.depth, 0.01) << i << j;
      EXPECT_LT(manifold.depth, 0.06) << i << j;
      for (const double factor : {0.98, 1.02}) {
        w.put(a, -factor * manifold.depth * Vec3(manifold.normal));  // away from b
        const Frame frame = w.step();
        ASSERT_EQ(frame.events.size(), 1u);
        EXPECT_EQ(frame.events[0].change, factor < 1 ? PairChange::stay : PairChange::end) << i << j;
      }
      EXPECT_EQ(w.detector.manifold(PairEvent{}).answer, Answer::maybe);
      w.detector.remove(a);
      EXPECT_EQ(w.detector.manifold(event).answer, Answer::maybe);
    }
  }
}

TEST(DetectorShapes, BoxesAreSolid) {
  WrittenWorld w;
  const ShapeId box = w.detector.add_box({5, 5, 5}), ball = w.detector.add_sphere(0.5);
  const ShapeId tree = w.detector.add_shape(w.torus), small = w.detector.add_box({1, 1, 1});
  for (const ShapeId inner : {ball, tree, small}) {
    const BodyId a = w.detector.add_body({{box, {}}}), b = w.detector.add_body({{inner, {}}});
    w.put(a, {0, 0, 0}), w.put(b, {0.5, 0.5, 0.5});
    EXPECT_EQ(w.only().change, PairChange::begin) << inner;
    w.detector.remove(a), w.detector.remove(b);
    w.step();
  }
}

TEST(DetectorEvents, BeginOnceStayAndEndOnce) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  const BodyId a = w.detector.add_body({{ball, {}}}), b = w.detector.add_body({{ball, {}}});
  const double apart[] = {3, 2.1, 1.9, 1.5, 1.9, 2.1, 1.9, 5};
  const PairChange wanted[] = {PairChange::possible, PairChange::possible, PairChange::begin, PairChange::stay,
                               PairChange::stay,     PairChange::end,      PairChange::begin, PairChange::end};
  for (int i = 0; i < 8; ++i) {
    w.put(b, {apart[i], 0, 0});
    const Frame frame = w.step();
    ASSERT_EQ(frame.events.size(), i < 2 ? 0u : 1u) << i;
    if (i < 2) continue;
    EXPECT_EQ(frame.events[0].change, wanted[i]) << i;
    EXPECT_EQ(frame.events[0].a, a);
    EXPECT_EQ(frame.events[0].b, b);
  }
}

TEST(DetectorEvents, EndAfterAsManyCertainNosAsAskedFor) {
  WrittenWorld w({.steps_to_end = 3});
  const ShapeId ball = w.detector.add_sphere(1);
  w.detector.add_body({{ball, {}}});
  const BodyId b = w.detector.add_body({{ball, {}}});
  const double apart[] = {1.9, 2.1, 9, 1.9, 2.1, 9, 9, 9};
  const PairChange wanted[] = {PairChange::begin, PairChange::stay, PairChange::stay, PairChange::stay,
                               PairChange::stay,  PairChange::stay, PairChange::end};
  for (int i = 0; i < 8; ++i) {
    w.put(b, {apart[i], 0, 0});
    const Frame frame = w.step();
    ASSERT_EQ(frame.events.size(), i < 7 ? 1u : 0u) << i;
    if (i < 7) {
      EXPECT_EQ(frame.events[0].change, wanted[i]) << i;
    }
  }
}

// Two links of a chain, which only their triangles can tell apart: nothing is certain within a small budget.
TEST(DetectorEvents, ArePossibleWhileTheBudgetDoesNotReach) {
  WrittenWorld w;
  const ShapeId torus = w.detector.add_shape(w.torus);
  const BodyId a = w.detector.add_body({{torus, {}}}), b = w.detector.add_body({{torus, {}}});
  w.put(a, {0, 0, 0}), w.put(b, {9, 0, 0});
  w.states[b.index].pose.rotation = {1, 0, 0, 0, 0, -1, 0, 1, 0};
  EXPECT_TRUE(w.silent());
  constexpr std::uint64_t kLittle = 100;  // four motions, and less than a level
  w.put(b, {0.75, 0, 0});
  w.step({.work = kLittle});  // has the broad phase look around
  for (int i = 0; i < 3; ++i) {
    const PairEvent event = w.only({.work = kLittle});
    EXPECT_EQ(event.change, PairChange::possible);
    EXPECT_EQ(event.verdict.answer, Answer::maybe);
    EXPECT_LT(event.verdict.separation_bound, 10);
  }
  EXPECT_TRUE(w.silent());
  w.put(b, {1.1, 0, 0});
  EXPECT_EQ(w.only().change, PairChange::begin);
  w.put(b, {0.751, 0, 0});
  const PairEvent event = w.only({.work = kLittle});  // it touched, and nothing says that it does no more
  EXPECT_EQ(event.change, PairChange::stay);
  EXPECT_EQ(event.verdict.answer, Answer::maybe);
  EXPECT_EQ(w.only().change, PairChange::end);
}

TEST(DetectorPairs, GoByGroupsMasksAndTheFilter) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  const BodyId a = w.detector.add_body({{ball, {}}}, {.filter = {.category = 1, .mask = 2}});
  const BodyId b = w.detector.add_body({{ball, {}}}, {.filter = {.category = 2, .mask = 4}});
  EXPECT_TRUE(w.silent());
  EXPECT_TRUE(w.detector.set_filter(b, {.category = 2, .mask = 1}));
  EXPECT_EQ(w.only().change, PairChange::begin);
  int asked = 0;
  w.detector.set_pair_filter([&](BodyId p, BodyId q) {
    ++asked;
    EXPECT_EQ(p, a);
    EXPECT_EQ(q, b);
    return false;
  });
  EXPECT_EQ(w.only().change, PairChange::end);
  EXPECT_TRUE(w.silent());
  EXPECT_GE(asked, 1);
  EXPECT_LE(asked, 4);  // a few times while they are near, at most
  w.detector.set_pair_filter(nullptr);
  EXPECT_EQ(w.only().change, PairChange::begin);
}

TEST(DetectorPairs, GoByTheGroupBeforeTheMasks) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  const BodyId a = w.detector.add_body({{ball, {}}}, {.filter = {.mask = 0, .group = 3}});
  const BodyId b = w.detector.add_body({{ball, {}}}, {.filter = {.mask = 0, .group = 3}});
  EXPECT_EQ(w.only().change, PairChange::begin);  // always, whatever the masks say
  EXPECT_TRUE(w.detector.set_filter(a, {.group = -3}));
  EXPECT_TRUE(w.detector.set_filter(b, {.group = -3}));
  EXPECT_EQ(w.only().change, PairChange::end);  // never
  EXPECT_TRUE(w.silent());
}

TEST(DetectorPairs, LeaveOutWhatIsStaticWhereTheFilterSaysSo) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  const BodyId body = w.detector.add_body({{ball, {}}}, {.filter = {.ignores_static = true}});
  w.detector.add_static({{ball, {}}}, {.translation = {0.5, 0, 0}});
  w.detector.add_half_space({0, 0, 1}, 0);
  EXPECT_TRUE(w.silent());
  EXPECT_TRUE(w.detector.set_filter(body, {}));
  EXPECT_EQ(w.step().events.size(), 2u);
}

TEST(DetectorPairs, PartsOfOneBodyAreNone) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  w.detector.add_body({{ball, {}}, {ball, {.translation = {0.5, 0, 0}}}});
  EXPECT_TRUE(w.silent());
}

TEST(DetectorPairs, NameThePartsThatTouchAndFollowTheJoints) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(0.5);
  const BodyId arm =
      w.detector.add_body({{ball, {}}, {ball, {.translation = {2, 0, 0}}}, {ball, {.translation = {4, 0, 0}}}});
  const BodyId other = w.detector.add_body({{ball, {.translation = {0, 9, 0}}}, {ball, {}}});
  w.put(arm, {0, 0, 0}), w.put(other, {4.5, 0, 0});
  const PairEvent event = w.only();
  EXPECT_EQ(event.part_a, 2u);
  EXPECT_EQ(event.part_b, 1u);
  EXPECT_TRUE(w.detector.set_local(arm, 2, {.translation = {0, 4, 0}}));
  EXPECT_EQ(w.only().change, PairChange::end);
  EXPECT_TRUE(w.detector.set_local(arm, 1, {.translation = {-30, 0, 0}}));  // farther than it has ever reached
  w.put(other, {-30.5, 0, 0});
  EXPECT_EQ(w.only().part_a, 1u);
  Pose mirror;
  mirror.rotation = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_FALSE(w.detector.set_local(arm, 0, mirror));
  EXPECT_FALSE(w.detector.set_local(arm, 3, {}));
}

TEST(DetectorPairs, OfStaticBodiesAreNone) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  const BodyId wall = w.detector.add_static({{ball, {}}}, {});
  const BodyId other = w.detector.add_static({{ball, {}}}, {.translation = {1, 0, 0}});
  w.detector.add_half_space({0, 0, 1}, 5);
  EXPECT_TRUE(w.silent());
  const BodyId body = w.detector.add_body({{ball, {}}});
  w.put(body, {10, 0, 40});
  EXPECT_TRUE(w.silent());
  EXPECT_TRUE(w.detector.move_static(other, {.translation = {10, 0, 41}}));
  EXPECT_EQ(w.only().change, PairChange::begin);
  EXPECT_FALSE(w.detector.move_static(body, {}));
  EXPECT_TRUE(w.detector.remove(other));
  EXPECT_EQ(w.only().change, PairChange::end);
  EXPECT_TRUE(w.detector.contains(wall));
}

TEST(DetectorPairs, AreOfScaledBodies) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1), tree = w.detector.add_shape(w.torus);
  const BodyId a = w.detector.add_body({{ball, {.scale = 2}}}), b = w.detector.add_body({{tree, {}}});
  w.put(a, {0, 0, 0}, 3);  // 6
  w.put(b, {16.001, 0, 0}, 10);
  EXPECT_TRUE(w.silent());
  w.put(b, {15.999, 0, 0}, 10);
  EXPECT_EQ(w.only().change, PairChange::begin);
}

TEST(DetectorBodies, AsleepAreAskedOnceAndCostNothing) {
  WrittenWorld w;
  const ShapeId tree = w.detector.add_shape(w.torus);
  const BodyId a = w.detector.add_body({{tree, {}}}), b = w.detector.add_body({{tree, {}}});
  w.put(a, {0, 0, 0}), w.put(b, {1, 0, 0});
  EXPECT_EQ(w.only().change, PairChange::begin);
  EXPECT_TRUE(w.detector.sleep(a));
  EXPECT_TRUE(w.detector.sleep(b));
  EXPECT_TRUE(w.detector.asleep(a));
  EXPECT_EQ(w.only().change, PairChange::stay);
  w.put(b, {50, 0, 0});  // without a word to the detector
  const Frame frame = w.step();
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].change, PairChange::stay);
  EXPECT_EQ(frame.events[0].verdict.answer, Answer::yes);
  EXPECT_EQ(frame.work, 0u);
  EXPECT_TRUE(w.detector.wake(b));
  EXPECT_EQ(w.only().change, PairChange::end);
}

TEST(DetectorBodies, RemovedOrTeleportedEndTheirTouches) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  const BodyId a = w.detector.add_body({{ball, {}}});
  const BodyId b = w.detector.add_body({{ball, {}}});
  EXPECT_EQ(w.only().change, PairChange::begin);
  EXPECT_TRUE(w.detector.teleport(b));
  const Frame frame = w.step();  // to where it was: it touches again
  ASSERT_EQ(frame.events.size(), 2u);
  EXPECT_EQ(frame.events[0].change, PairChange::end);
  EXPECT_EQ(frame.events[1].change, PairChange::begin);
  EXPECT_TRUE(w.detector.remove(a));
  const BodyId c = w.detector.add_body({{ball, {}}});  // with the same index
  EXPECT_EQ(c.index, a.index);
  const Frame next = w.step();
  ASSERT_EQ(next.events.size(), 2u);
  EXPECT_EQ(next.events[0].change, PairChange::end);
  EXPECT_EQ(next.events[0].a, a);
  EXPECT_EQ(next.events[1].change, PairChange::begin);
  EXPECT_EQ(next.events[1].a, c);
}

TEST(DetectorBodies, WithStatesThatAreNotValidAreRefusedAndTheOthersAnswered) {
  WrittenWorld w;
  const ShapeId ball = w.detector.add_sphere(1);
  BodyId bodies[4];
  for (BodyId& body : bodies) body = w.detector.add_body({{ball, {}}});
  w.put(bodies[0], {NAN, 0, 0});
  w.states[bodies[1].index].pose.rotation = {1, 0, 0, 0, 1, 0, 0, 0, -1};
  const Frame frame = w.step();
  ASSERT_EQ(frame.refused.size(), 2u);
  EXPECT_EQ(frame.refused[0], bodies[0].index);
  EXPECT_EQ(frame.refused[1], bodies[1].index);
  ASSERT_EQ(frame.events.size(), 1u);
  EXPECT_EQ(frame.events[0].a, bodies[2]);
}

TEST(Detector, AnswersEachStepWhenItIsAskedFarFromTimeZero) {
  for (const double start : {1.7e9, -1.7e9, 0.99 * kMaxSteps * kStep, -0.99 * kMaxSteps * kStep}) {
    DetectorOptions options;
    options.time_step = kStep;
    options.start = start;
    std::vector<BodyState> states(2);
    for (BodyState& state : states) state.expiry = -INFINITY;  // asked for at every step
    Detector detector(states_of(states), options);
    const ShapeId ball = detector.add_sphere(1);
    for (int i = 0; i < 2; ++i) detector.add_body({{ball}});
    for (int k = 0; k < 200; ++k) {
      const Frame frame = detector.step(start + kStep * k);
      ASSERT_EQ(frame.time, start + kStep * k) << k;
      ASSERT_EQ(frame.events.size(), 1u) << k;
    }
  }
}

TEST(Detector, SaysWhenThereIsNoMemory) {
  for (const bool in_step : {false, true}) {
    WrittenWorld w;
    const ShapeId ball = w.detector.add_sphere(1);
    BodyId first = w.detector.add_body({{ball, {}}});
    for (int i = 1; in_step && i < 60; ++i) w.detector.add_body({{ball, {}}});
    bool thrown = false, said = false;
    test::allocation_fails = true;
    try {
      for (int i = 0; !in_step && i < 60; ++i) w.detector.add_body({{ball, {}}});
      said = w.step().out_of_memory;
    } catch (const std::bad_alloc&) {
      thrown = true;
    }
    test::allocation_fails = false;
    EXPECT_EQ(thrown, !in_step);
    EXPECT_EQ(said, in_step);
    const Frame frame = w.step();
    EXPECT_TRUE(frame.out_of_memory);
    EXPECT_TRUE(frame.events.empty());
    EXPECT_FALSE(w.detector.contains(first));
    EXPECT_FALSE(w.detector.remove(first));
    EXPECT_EQ(w.detector.add_body({{ball, {}}}), kNoBody);
  }
}

// No body is asked while nothing can touch.
TEST(Detector, SleepsWhileNothingCanTouch) {
  std::size_t asked = 0;
  Detector detector(
      [&](double, std::span<const BodyIndex> bodies, std::span<BodyState> states) {
        for (std::size_t i = 0; i < bodies.size(); ++i, ++asked) {
          states[i] = BodyState{};
          states[i].pose.translation = {100.0 * bodies[i], 0, 1000};
          states[i].velocity = {0, 0, -1};
          states[i].acceleration = 0.1;
        }
      },
      {.time_step = kStep, .watch = false});
  const ShapeId ball = detector.add_sphere(1);
  for (int i = 0; i < 10; ++i) detector.add_body({{ball, {}}});
  detector.add_half_space({0, 0, 1}, 0);
  for (int i = 0; i < 1000; ++i) EXPECT_EQ(detector.step(i * kStep).steps, i == 0 ? 1u : 0u) << i;
  EXPECT_LT(asked, 100u);  // half-spaces once, the broad phase every 254 steps
  EXPECT_GT(detector.step(10).next_time, 10);
}

// A class that matters more is certain first, and within a class no pair starves.
TEST(DetectorBudget, GoesToTheMoreImportantFirstAndThenRound) {
  WrittenWorld w;
  const ShapeId torus = w.detector.add_shape(w.torus);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 20; ++i) {
    bodies.push_back(w.detector.add_body({{torus, {}}}, {.importance = static_cast<std::uint8_t>(i < 4 ? 0 : 1)}));
    w.put(bodies.back(), {i * 10.0 / 2 - (i % 2) * 4, 0, 0});
  }
  std::vector<int> certain(20);
  for (int step = 0; step < 40; ++step) {
    for (BodyId id : bodies) w.states[id.index].pose.translation[1] += id.index % 2 == 0 ? 1e-4 : 0;
    for (const PairEvent& event : w.step({.work = 1000}).events) {
      certain[event.a.index] += event.verdict.answer == Answer::yes;
    }
  }
  EXPECT_EQ(certain[0], 40);
  EXPECT_EQ(certain[2], 40);
  int most = 0;
  for (int i = 4; i < 20; i += 2) {
    EXPECT_GT(certain[static_cast<std::size_t>(i)], 3) << i;
    most = std::max(most, certain[static_cast<std::size_t>(i)]);
  }
  EXPECT_LT(most, 40);  // the budget did not suffice for all
}

TEST(DetectorBudget, WhatTheLastStepFoundCostsNextToNothing) {
  WrittenWorld w;
  const ShapeId torus = w.detector.add_shape(w.torus);
  std::vector<BodyId> bodies;
  for (int i = 0; i < 24; ++i) {
    bodies.push_back(w.detector.add_body({{torus, {}}}));
    // Pairs that touch, and pairs that are nearly as close and do not.
    const int place = i / 2;
    w.put(bodies.back(), {10.0 * place, i % 4 == 1 ? 0.3 : 0, i % 4 == 3 ? 0.7 : 0});
  }
  Frame frame;
  for (int step = 0; step < 12; ++step) {
    for (const BodyId id : bodies) w.states[id.index].pose.translation[2] += id.index % 2 == 0 ? 1e-6 : 0;
    const std::uint64_t enough = frame.pairs * (kPairWork + 4 * kMotionWork);
    frame = w.step(step < 4 ? Budget{} : Budget{.work = enough});
    EXPECT_EQ(frame.pairs, 12u);
    EXPECT_EQ(frame.certain, frame.pairs) << step;
  }
}

TEST(DetectorBudget, InTimeAnswersWhatItReachesAndTellsTheRest) {
  WrittenWorld w;
  const ShapeId torus = w.detector.add_shape(w.torus);
  for (int i = 0; i < 40; ++i) w.put(w.detector.add_body({{torus, {}}}), {0.3 * i, 0, 0});
  const Frame late = w.step({.time = std::chrono::nanoseconds(1)});
  EXPECT_LT(late.certain, late.pairs + (late.pairs == 0));
  const Frame calm = w.step({.time = std::chrono::seconds(100)});
  EXPECT_EQ(calm.certain, calm.pairs);
  EXPECT_GT(calm.pairs, 100u);
}

TEST(DetectorLoad, IsForeseenFromTheEventsOfTheBroadPhase) {
  // Pairs that fly towards each other and begin to overlap one after the other.
  constexpr int kPairs = 30;
  std::vector<BodyState> states(std::size_t{2} * kPairs);
  Detector detector(
      [&](double time, std::span<const BodyIndex> bodies, std::span<BodyState> given) {
        for (std::size_t i = 0; i < bodies.size(); ++i) {
          given[i] = states[bodies[i]];
          for (std::size_t k = 0; k < 3; ++k) given[i].pose.translation[k] += time * given[i].velocity[k];
        }
      },
      {.time_step = kStep, .watch = false});
  const PackedSphereTree tree = test::build_tree(test::torus(12, 6, 0.75, 0.25));
  const ShapeId torus = detector.add_shape(tree);
  for (int i = 0; i < kPairs; ++i) {
    for (int k = 0; k < 2; ++k) {
      const BodyId id = detector.add_body({{torus, {}}});
      BodyState& state = states[id.index];
      state.pose.translation = {k == 0 ? 0.0 : 2 + 0.05 * i, 10.0 * i, 0};
      state.velocity = {k == 0 ? 0.0 : -1.0, 0, 0};
    }
  }
  detector.step(0);
  double error = 0, worse = 0;
  for (int step = 1; step < 150; ++step) {
    std::array<StepLoad, 10> loads;
    const std::size_t known = detector.predict_load(loads);
    EXPECT_EQ(known, loads.size());
    EXPECT_NEAR(loads[0].time, step * kStep, 1e-12);
    const Frame frame = detector.step(step * kStep);
    if (step < 50) continue;  // it has to learn first
    error += std::fabs(loads[0].pairs - static_cast<double>(frame.pairs));
    worse += static_cast<double>(frame.pairs);
  }
  EXPECT_LT(error, 0.2 * worse);
}

}  // namespace
}  // namespace orchard::runtime
