#include <gtest/gtest.h>

#include <cmath>

#include "../support/effort.h"
#include "any_broad_phase.h"
#include "query_judge.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Rays, segments, spheres, boxes and nearest bodies against asking every body, in more digits.
namespace orchard::runtime {
namespace {

using test::ask_everything;
using test::Judge;

using test::kStep;

class Queries : public testing::TestWithParam<test::AnyMethod> {};
INSTANTIATE_TEST_SUITE_P(BroadPhase, Queries, testing::ValuesIn(test::kMethods));

// Frames of any length: the answers are about time(), a step's.
TEST_P(Queries, AreAnsweredAsByAskingEveryBody) {
  const bool events = GetParam() == test::AnyMethod::events;
  const std::uint64_t first = orchard::test::first_seed(), seeds = (events ? 20 : 3) * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    test::Draw draw(seed + 5000);
    const std::size_t n = !events ? 20 : seed % 4 == 0 ? 1000 : seed % 4 == 1 ? 300 : 1 + draw.bits() % 250;
    const double ball = std::cbrt(static_cast<double>(n)) * draw.uniform(0.7, 4);
    const test::MovingBodies bodies({.bodies = n,
                                     .ball = ball,
                                     .min_radius = 0,
                                     .max_radius = seed % 7 == 0 ? ball : 0.6,
                                     .period = draw.uniform(0.1, 0.6),
                                     .half_spaces = 0.3,
                                     .staggered = seed % 2 == 0,
                                     .end = 0.6,
                                     .wind = seed % 5 == 3 ? Vec3{30, -10, 5} : Vec3{}},
                                    seed);
    BroadPhase world = test::make_broad_phase(bodies.source(), {.method = GetParam(), .common = {.time_step = kStep}});
    for (std::size_t i = 0; i < n; ++i) world.add();
    BodyQueries queries(world);
    std::vector<Motion> motions(n);
    const Judge judge(queries, n, [&](BodyIndex i) { return &motions[i]; });
    const auto ask = [&] {
      for (BodyIndex i = 0; i < n; ++i) motions[i] = bodies.motion(i, queries.time());
      for (int k = 0; k < 2; ++k) ask_everything(judge, draw, ball);
    };
    EXPECT_EQ(queries.time(), 0);
    ask();  // before the first step
    const double frame = draw.uniform(0.004, 0.05);
    for (int k = 0; k * frame < 0.6; ++k) {
      const double t = k * frame;
      for (Advance now = world.advance(t); !now.pairs.empty(); now = world.advance(t)) {
        if (draw.bits() % 8 != 0) continue;
        EXPECT_EQ(queries.time(), now.time);
        ask();
      }
      EXPECT_NEAR(queries.time(), kStep * std::floor(t / kStep + 1e-6), 1e-9);
      ask();
      if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed << " at " << t;
    }
  }
}

// An application that adds, removes, teleports, cancels, filters and gives motions that are none, within budgets or
// not, and asks at any moment.
class AskingApplication {
 public:
  AskingApplication(std::uint64_t seed, const test::AnyOptions& options, std::size_t crowd)
      : draw_(seed),
        crowd_(crowd),
        world_(test::make_broad_phase(values_of(values_), options)),
        queries_(world_),
        ball_(draw_.uniform(1, 4) * std::cbrt(static_cast<double>(crowd))) {}

  void run(int steps) {
    for (int step = 0; step < steps; ++step) {
      for (std::size_t i = 0; i < values_.size(); ++i) {
        Motion& m = values_[i];
        if (known_[i].fixed || !is_valid(m)) continue;
        m.position = m.position + kStep * m.velocity;
        if (m.expiry < kStep * (step + 1)) m.expiry = kStep * (step + draw_.uniform(0, 30));
      }
      advance(step);
      for (std::size_t k = draw_.bits() % 4; k > 0; --k) change(step);
      ask();
      if (testing::Test::HasFatalFailure()) FAIL() << "step " << step;
    }
  }

 private:
  struct Known {
    bool alive = false, fixed = false;
    BodyId id;
  };
  bool chance(double share) { return draw_.uniform(0, 1) < share; }

  void advance(int step) {
    if (step % 15 == 0) mode_ = draw_.bits() % 3;
    Budget budget;
    if (mode_ == 1) budget.work = 1 + draw_.bits() % crowd_;
    const double t = kStep * step;
    const auto go = [&] { return mode_ == 0 ? world_.advance(t) : world_.advance(t, budget); };
    for (Advance now = go(); now.time <= t + kStep / 2;) now = go();  // all steps up to now: the values are of this one
  }

  Motion random_motion(int step) {
    Motion m;
    m.position = draw_.in_ball(ball_);
    m.velocity = draw_.uniform(0, 10) * draw_.direction();
    m.radius = chance(0.02) ? ball_ : draw_.uniform(0, 1);
    if (chance(0.5)) m.expiry = kStep * (step + draw_.uniform(0, 30));
    return m;
  }

  BodyFilter random_filter() {
    if (chance(0.6)) return {};
    return {static_cast<std::uint32_t>(draw_.bits() & 7), static_cast<std::uint32_t>(draw_.bits() & 7), 0};
  }

  void change(int step) {
    if (world_.size() < crowd_ / 2 || chance(0.1)) {
      for (std::size_t k = draw_.bits() % crowd_ + 1; k > 0; --k) {
        const Motion m = random_motion(step);
        const bool fixed = chance(0.2);
        const BodyId id = fixed ? world_.add_static(m, 0, random_filter()) : world_.add(0, random_filter());
        if (id.index >= values_.size()) values_.resize(id.index + 1), known_.resize(id.index + 1);
        values_[id.index] = m;
        known_[id.index] = {true, fixed, id};
      }
    }
    const auto i = static_cast<BodyIndex>(draw_.bits() % values_.size());
    Known& known = known_[i];
    if (!known.alive) return;
    const double dice = draw_.uniform(0, 1);
    if (dice < 0.3) {
      world_.remove(known.id);
      known.alive = false;
    } else if (dice < 0.6) {
      values_[i] = random_motion(step);
      known.fixed ? world_.move_static(known.id, values_[i]) : world_.teleport(known.id);
    } else if (dice < 0.7 && !known.fixed) {
      values_[i].radius = -1;
      world_.cancel(known.id);
    } else {
      world_.set_filter(known.id, random_filter());
    }
  }

  void ask() {
    Judge judge(
        queries_, values_.size(), [this](BodyIndex i) { return known_[i].alive ? &values_[i] : nullptr; },
        [this](BodyIndex i) { return world_.filter_of(known_[i].id); });
    if (chance(0.5))
      judge.set_filter(
          {static_cast<std::uint32_t>(draw_.bits() & 7), static_cast<std::uint32_t>(1 + (draw_.bits() & 6))});
    ask_everything(judge, draw_, ball_);
  }

  test::Draw draw_;
  std::size_t crowd_;
  std::uint64_t mode_ = 0;
  std::vector<Motion> values_;
  std::vector<Known> known_;
  BroadPhase world_;
  BodyQueries queries_;
  double ball_;
};

TEST_P(Queries, KeepUpWithAllChanges) {
  const bool events = GetParam() == test::AnyMethod::events;
  const std::uint64_t first = orchard::test::first_seed(), seeds = (events ? 20 : 3) * orchard::test::more();
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    test::AnyOptions options{.method = GetParam(), .common = {.time_step = kStep}};
    if (seed % 3 == 1) options.common.window = static_cast<std::uint32_t>(1 + seed % 30);
    AskingApplication application(seed, options, events ? (seed % 2 == 0 ? 300 : 150) : 12);
    application.run(60);
    if (testing::Test::HasFatalFailure()) FAIL() << "seed " << seed;
  }
}

}  // namespace
}  // namespace orchard::runtime
