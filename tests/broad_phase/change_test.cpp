#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "any_broad_phase.h"
#include "runtime/every_machine.h"
#include "runtime/numbers.h"
#include "worlds.h"

namespace orchard::runtime {
namespace {

using test::kStep;

// An application that keeps values, moves bodies itself and now and then breaks its own word.
class ChangingApplication {
 public:
  // period > 0: all bounds hold for so many steps, and up to the same ones.
  ChangingApplication(std::uint64_t seed, const test::AnyOptions& options, int bodies = 20, int period = 0)
      : draw_(seed),
        ball_(15 * std::cbrt(bodies / 20.0)),
        period_(period),
        world_(test::make_broad_phase(values_of(values_), options)) {
    for (int i = 0; i < bodies; ++i) add();
  }

  // A frame: bodies move, changes happen, and the pairs must be those that touch.
  void frame(int step) {
    const double time = kStep * step;
    for (BodyIndex i = 0; i < values_.size(); ++i) {
      Motion& m = values_[i];
      if (!alive_[i] || fixed_[i]) continue;
      const Vec3 a = draw_.uniform(0, m.acceleration) * draw_.direction();
      m.position = m.position + kStep * m.velocity + (kStep * kStep / 2) * a;
      m.velocity = m.velocity + kStep * a;
    }
    if (period_ > 0 && step % period_ == 0) renew(kStep * (step + period_));
    const Advance now = world_.advance(time);
    std::vector<BodyPair> expected;
    for (BodyIndex i = 0; i < values_.size(); ++i) {
      for (BodyIndex j = i + 1; j < values_.size(); ++j) {
        if (alive_[i] && alive_[j] && !(fixed_[i] && fixed_[j]) && spheres_touch(values_[i], values_[j])) {
          expected.push_back({i, j});
        }
      }
    }
    ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), expected) << "step " << step;
    ASSERT_EQ(now.incomplete_from, kNoClass);
    change(time);
  }
  std::uint64_t motions_asked() const { return world_.motions_asked(); }

 private:
  Motion random_motion() {
    Motion m;
    m.position = draw_.in_ball(ball_);
    m.velocity = draw_.uniform(0, 10) * draw_.direction();
    m.radius = draw_.uniform(0, 1.5);
    if (draw_.uniform(0, 1) < 0.03) m.radius = 20;  // larger than everything else together
    m.acceleration = draw_.uniform(0, 10);
    if (period_ > 0) m.expiry = expiry_;
    return m;
  }

  void add() {
    const Motion m = random_motion();
    const bool fixed = draw_.uniform(0, 1) < 0.2;
    const BodyId id = fixed ? world_.add_static(m) : world_.add(static_cast<std::uint8_t>(draw_.bits() % 3));
    const BodyIndex body = id.index;
    if (body >= values_.size()) {
      values_.resize(body + 1), alive_.resize(body + 1), fixed_.resize(body + 1), ids_.resize(body + 1);
    }
    ids_[body] = id;
    values_[body] = m;
    alive_[body] = 1;
    fixed_[body] = fixed;
  }

  void renew(double expiry) {  // velocities may jump as bounds expire
    expiry_ = expiry;
    for (Motion& m : values_) {
      m.expiry = expiry;
      m.velocity = draw_.uniform(0, 10) * draw_.direction();
    }
  }

  void change(double time) {
    const double dice = draw_.uniform(0, 1);
    const BodyIndex body = static_cast<BodyIndex>(draw_.bits() % values_.size());
    if (dice < 0.1) {
      add();
    } else if (!alive_[body]) {
      return;
    } else if (dice < 0.2) {
      world_.remove(ids_[body]);
      alive_[body] = 0;
    } else if (dice < 0.4) {  // anywhere, and faster: teleported
      values_[body] = random_motion();
      fixed_[body] ? world_.move_static(ids_[body], values_[body]) : world_.teleport(ids_[body]);
    } else if (dice < 0.5 && !fixed_[body]) {  // a kick
      values_[body].velocity = 30 * draw_.direction();
      world_.cancel(ids_[body]);
    } else if (dice < 0.6 && !fixed_[body] && period_ == 0) {  // announced to last for a while only
      values_[body].expiry = time + draw_.uniform(0.01, 0.3);
      world_.cancel(ids_[body]);
    }
    for (BodyIndex i = 0; i < values_.size() && period_ == 0; ++i) {  // renewed in time
      if (values_[i].expiry < time + 2 * kStep) values_[i].expiry = time + draw_.uniform(0.1, 0.3);
    }
  }

  test::Draw draw_;
  double ball_, expiry_ = 0;
  int period_;
  std::vector<Motion> values_;
  std::vector<char> alive_, fixed_;
  std::vector<BodyId> ids_;
  BroadPhase world_;
};

class Changes : public testing::TestWithParam<test::AnyMethod> {};
INSTANTIATE_TEST_SUITE_P(BroadPhase, Changes, testing::ValuesIn(test::kMethods));

TEST_P(Changes, TakePartFromTheNextStep) {
  for (std::uint64_t seed = 0; seed < (GetParam() == test::AnyMethod::events ? 400 : 30); ++seed) {
    test::AnyOptions options{.method = GetParam(), .common = {.time_step = kStep}};
    if (seed % 2 == 1) options.rebuild = test::Rebuild::everything;
    if (seed % 3 == 1) options.common.window = static_cast<std::uint32_t>(1 + seed % 30);
    ChangingApplication application(seed, options);
    for (int step = 0; step < 150; ++step) {
      application.frame(step);
      if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
  }
}

// Most bodies are updated a step ahead of the common expiry then: what changes in between has to take part, too.
TEST(BroadPhase, ChangesAroundACommonExpiryTakePart) {
  for (std::uint64_t seed = 0; seed < 24; ++seed) {
    const int period = 3 + static_cast<int>(seed % 9), bodies = seed % 3 == 0 ? 300 : seed % 3 == 1 ? 189 : 60;
    const auto machine = test::on_portable_machine(seed % 5 == 0);
    ChangingApplication application(seed, {.common = {.time_step = kStep}}, bodies, period);
    for (int step = 0; step < 60; ++step) {
      application.frame(step);
      if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
    }
  }
}

TEST(BroadPhase, SharesTheLooksOfACommonExpiryBetweenTwoSteps) {
  constexpr double kExactStep = 1.0 / 64;  // all times are exact
  const test::MovingBodies bodies({.bodies = 400, .ball = 300, .period = 12 * kExactStep}, 1);
  BroadPhase world(bodies.source(), {.time_step = kExactStep});
  for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
  std::uint64_t asked = 0;
  for (int step = 0; step < 63; ++step) {
    const Advance now = world.advance(kExactStep * step);
    if (step > 0) {
      EXPECT_LT(world.motions_asked() - asked, 300u) << "step " << step;
    }
    asked = world.motions_asked();
    EXPECT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), bodies.touching(kExactStep * step));
  }
}

// Every other body gives its next bound only at the step after the one at which the last expires.
TEST(BroadPhase, BodiesThatRenewTheirBoundsLateTakePart) {
  constexpr double kExactStep = 1.0 / 64, kPeriod = 12 * kExactStep;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const test::MovingBodies bodies({.bodies = seed % 2 == 0 ? 400u : 100u, .ball = 30, .period = kPeriod}, seed);
    const MotionSource inner = bodies.source();
    const MotionSource source = [&](double time, std::span<const BodyIndex> ids, std::span<Motion> motions) {
      inner(time, ids, motions);
      for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] % 2 == 1 && std::fmod(time, kPeriod) == 0) motions[i].expiry = time;
      }
    };
    BroadPhase world(source, {.time_step = kExactStep});
    for (std::size_t i = 0; i < bodies.size(); ++i) world.add();
    for (int step = 0; step < 63; ++step) {
      const Advance now = world.advance(kExactStep * step);
      ASSERT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), bodies.touching(kExactStep * step))
          << "seed " << seed << ", step " << step;
    }
  }
}

TEST(BroadPhase, AChangeWhileAsleepCountsFromThePresent) {
  std::vector<Motion> values(2);
  values[0].position = {0, 0, 0};
  values[1].position = {100, 0, 0};
  values[0].radius = values[1].radius = 1;
  std::vector<double> asked;
  const MotionSource inner = values_of(values);
  const MotionSource source = [&](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    asked.push_back(time);
    inner(time, bodies, motions);
  };
  BroadPhase world(source, {.time_step = kStep});
  world.add(), world.add();
  EXPECT_TRUE(world.advance(0).pairs.empty());
  EXPECT_TRUE(world.advance(0.505).pairs.empty());
  asked.clear();
  values[1].position = {1, 0, 0};
  world.teleport(world.id_of(1));
  EXPECT_TRUE(world.advance(0.507).pairs.empty());  // no step between
  const Advance now = world.advance(0.512);
  ASSERT_EQ(now.pairs.size(), 1u);
  EXPECT_NEAR(now.time, 0.51, 1e-12);
  for (const double time : asked) EXPECT_NEAR(time, 0.51, 1e-12);
}

TEST(BroadPhase, RejectsWhatIsNotAPlace) {
  BroadPhase world({}, {});
  Motion bad;
  bad.radius = -1;
  EXPECT_EQ(world.add_static(bad), kNoBody);
  bad.radius = 1;
  bad.position[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(world.add_static(bad), kNoBody);
  EXPECT_EQ(world.size(), 0u);
}

TEST(BroadPhase, WithoutBodiesSleepsForEver) {
  BroadPhase world({}, {});
  EXPECT_EQ(world.advance(1e9).time, std::numeric_limits<double>::infinity());
  EXPECT_EQ(world.add_static(Motion{}).index, 0u);
  EXPECT_EQ(world.add_static(Motion{}).index, 1u);
  EXPECT_TRUE(world.advance(2e9).pairs.empty());  // static bodies are no pair
}

// 8.2: with too little budget the important pairs are still right, and the report says what may be missing.
TEST_P(Changes, InterruptedKeepTheImportantPairs) {
  int interrupted = 0;
  for (std::uint64_t seed = 0; seed < (GetParam() == test::AnyMethod::events ? 40 : 6); ++seed) {
    const test::MovingBodies bodies({.bodies = 200, .ball = 25, .staggered = seed % 2 == 0}, seed);
    BroadPhase world = test::make_broad_phase(bodies.source(), {.method = GetParam(), .common = {.time_step = kStep}});
    std::vector<unsigned> importance;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      importance.push_back(i < 20 ? 0 : i < 60 ? 3 : 7);
      world.add(static_cast<std::uint8_t>(importance.back()));
    }
    test::Draw draw(seed);
    std::map<int, unsigned> complete;
    for (int step = 0; step < 60; ++step) {
      const Budget budget{.work = 50 + draw.bits() % 300};
      const Advance now = world.advance(kStep * step, budget);
      std::vector<BodyPair> expected, found;
      const auto counts = [&](const BodyPair& pair) {
        return std::max(importance[pair.a], importance[pair.b]) < now.incomplete_from;
      };
      const auto touching = bodies.touching(kStep * step);
      std::copy_if(touching.begin(), touching.end(), std::back_inserter(expected), counts);
      std::copy_if(now.pairs.begin(), now.pairs.end(), std::back_inserter(found), counts);
      ASSERT_EQ(found, expected) << "seed " << seed << " step " << step;
      interrupted += now.incomplete_from != kNoClass;
    }
    for (int step = 60; step < 63; ++step) world.advance(kStep * step);  // time enough again: all is right
    const Advance now = world.advance(kStep * 63);
    EXPECT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), bodies.touching(kStep * 63)) << seed;
    EXPECT_EQ(now.incomplete_from, kNoClass);
  }
  EXPECT_GT(interrupted, GetParam() == test::AnyMethod::events ? 100 : 2);
}

TEST_P(Changes, WithoutAnyTimeGetSomewhereAndSayWhatIsMissing) {
  const test::MovingBodies bodies({.bodies = 300, .ball = 30}, 1);
  BroadPhase world = test::make_broad_phase(bodies.source(), {.method = GetParam(), .common = {.time_step = kStep}});
  for (std::size_t i = 0; i < bodies.size(); ++i) world.add(static_cast<std::uint8_t>(i % 2));
  std::uint64_t asked = 0;
  for (int step = 0; step < 50; ++step) {
    const Advance now = world.advance(kStep * step, Budget{.time = std::chrono::nanoseconds(0)});
    for (const BodyPair& pair : now.pairs) {
      ASSERT_TRUE(spheres_touch(bodies.motion(pair.a, now.time), bodies.motion(pair.b, now.time)));
    }
    EXPECT_EQ(step > 0 || now.incomplete_from == 0, true);
    EXPECT_LE(world.motions_asked() - asked, 2 * kWorkPerClock);
    asked = world.motions_asked();
  }
  EXPECT_GT(asked, 50u);
  world.advance(kStep * 50);
  const Advance now = world.advance(kStep * 51);
  EXPECT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), bodies.touching(kStep * 51));
}

TEST(BroadPhase, TimeNeverRunsBackwards) {  // a smaller time than before changes nothing
  std::vector<Motion> values(2);
  values[1].position = {100, 0, 0};
  BroadPhase world(values_of(values), {.time_step = kStep});
  world.add(), world.add();
  world.advance(1);
  world.advance(0.5);
  values[1].position = {0, 0, 0};
  world.teleport(world.id_of(1));
  EXPECT_TRUE(world.advance(0.7).pairs.empty());
  EXPECT_NEAR(world.advance(1.02).time, 1.01, 1e-9);
}

// What the steps need at most, of bodies of which every so many are cancelled at each step.
std::size_t memory_where_cancelled(BodyIndex every, double expiry) {
  constexpr BodyIndex kPerAxis = 14, kCount = kPerAxis * kPerAxis * kPerAxis;
  const MotionSource source = [&](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const BodyIndex i = bodies[k];
      test::Draw draw(i);
      Motion& m = motions[k] = {};
      m.velocity = 0.2 * draw.direction();
      const BodyIndex row = i / kPerAxis, layer = row / kPerAxis;
      m.position = 4.0 * Vec3{1.0 * (i % kPerAxis), 1.0 * (row % kPerAxis), 1.0 * layer} + time * m.velocity;
      m.radius = 1.5;
      m.acceleration = 0.5;
      m.expiry = expiry;
    }
  };
  BroadPhase world(source, {.time_step = kStep});
  for (BodyIndex i = 0; i < kCount; ++i) world.add();
  std::size_t most = 0;
  for (int step = 0; step < 100; ++step) {
    for (BodyIndex i = 0; step > 0 && every > 0 && i < kCount; i += every) world.cancel(world.id_of(i));
    world.advance(kStep * step);
    most = std::max(most, world.memory_bytes());
  }
  return most;
}

TEST(BroadPhase, CancelledBodiesTakeLittleMemory) {
  for (const double expiry : {200 * kStep, std::numeric_limits<double>::infinity()}) {
    const std::size_t calm = memory_where_cancelled(0, expiry), changing = memory_where_cancelled(4, expiry);
    EXPECT_LT(changing, calm + calm / 4) << "of bounds until " << expiry;
  }
}

}  // namespace
}  // namespace orchard::runtime
