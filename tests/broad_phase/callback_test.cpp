#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "orchard/runtime/broad_queries.h"
#include "runtime/numbers.h"
#include "runtime/split_mix.h"
#include "support/effort.h"

// What the application's functions may not do, values that are missing, and steps that are left out.
namespace orchard::runtime {
namespace {

using test::kStep;
using Pairs = std::set<std::pair<BodyIndex, BodyIndex>>;

Pairs pairs_of(const Advance& now) {
  Pairs pairs;
  for (const BodyPair& pair : now.pairs) pairs.insert({pair.a, pair.b});
  return pairs;
}

TEST(ValuesOf, RefusesBodiesBeyondTheEndOfItsVector) {
  for (std::uint64_t i = 0; i < 300 * orchard::test::more(); ++i) {
    test::SplitMix draw(orchard::test::first_seed() + i);
    std::vector<Motion> values(draw.bits() % 250);
    for (Motion& motion : values) motion.radius = 0.1;
    values.shrink_to_fit();
    BroadPhase world(values_of(values), {.validate = i % 2 == 0});
    std::vector<BodyIndex> beyond;
    const std::size_t bodies = 1 + draw.bits() % 250;
    for (std::size_t k = 0; k < bodies; ++k) {
      if (draw.uniform(0, 1) < 0.4) {
        world.add_static({.position = {1.0 * static_cast<double>(k), 50, 0}, .radius = 0.1});
        continue;
      }
      const BodyIndex body = world.add().index;
      if (body >= values.size()) {
        beyond.push_back(body);
      } else {
        values[body].position = {1.0 * body, 0, 0};
      }
    }
    const Advance now = world.advance(0);
    ASSERT_TRUE(std::equal(now.refused.begin(), now.refused.end(), beyond.begin(), beyond.end())) << i;
    ASSERT_TRUE(now.pairs.empty());
  }
}

struct Meddler {
  BroadPhase* world = nullptr;
  BodyQueries* queries = nullptr;
  int calls = 0;

  void meddle() {
    ++calls;
    const BodyId body{0, 1};
    for (int i = 0; i < 100; ++i) EXPECT_EQ(world->add(), kNoBody);
    EXPECT_EQ(world->add_static({}), kNoBody);
    EXPECT_FALSE(world->remove(body) || world->cancel(body) || world->teleport(body) || world->move_static(body, {}));
    EXPECT_FALSE(world->set_importance(body, 1) || world->set_filter(body, {}));
    world->set_pair_filter([](BodyId, BodyId) { return false; });
    EXPECT_TRUE(world->advance(1e6).time_refused);
    EXPECT_TRUE(world->advance(1e6, Budget{.work = 1}).time_refused);
    EXPECT_EQ(world->skip_to(1e6), 0u);
    EXPECT_TRUE(queries->touching_sphere({}, 5).empty());
    EXPECT_TRUE(queries->all_hits({{-9, 0, 0}, {1, 0, 0}}).empty());
    EXPECT_TRUE(queries->nearest({}, 3).empty());
    EXPECT_FALSE(queries->first_hit({{-9, 0, 0}, {1, 0, 0}}));
    EXPECT_TRUE(queries->refused());
  }
};

TEST(CallsFromWithinAdvance, AreRefusedAndChangeNothing) {
  for (const std::size_t bodies : {5u, 300u}) {
    Meddler meddler;
    test::SplitMix draw(bodies);
    std::vector<Motion> values(bodies);
    const auto move = [&] {
      for (Motion& motion : values) {
        motion.radius = 0.4, motion.expiry = 0;
        for (double& x : motion.position) x = draw.uniform(0, std::cbrt(static_cast<double>(bodies)));
      }
    };
    move();
    const MotionSource plain = values_of(values);
    BroadPhase world([&](double time, std::span<const BodyIndex> asked, std::span<Motion> motions) {
      meddler.meddle();
      plain(time, asked, motions);
    });
    BroadPhase quiet(plain);
    BodyQueries queries(world), alike(quiet);
    meddler.world = &world, meddler.queries = &queries;
    for (std::size_t i = 0; i < bodies; ++i) world.add(), quiet.add();
    world.set_pair_filter([&](BodyId, BodyId) { return meddler.meddle(), true; });
    for (int step = 0; step < 4; ++step) {
      ASSERT_EQ(pairs_of(world.advance(step * kStep)), pairs_of(quiet.advance(step * kStep)));
      const auto near = queries.touching_sphere({1, 1, 1}, 1), same = alike.touching_sphere({1, 1, 1}, 1);
      ASSERT_TRUE(std::equal(near.begin(), near.end(), same.begin(), same.end()));
      ASSERT_FALSE(queries.refused());
      ASSERT_EQ(queries.nearest({}, 4).size(), alike.nearest({}, 4).size());
      move();
    }
    EXPECT_GT(meddler.calls, 0);
    EXPECT_EQ(world.size(), bodies);
    EXPECT_TRUE(world.remove({0, 1}));
  }
}

// Bodies on circles and lines, static ones, some at rest; each judged where it is at the step that comes after a pause.
struct Paused {
  explicit Paused(std::uint64_t seed) : draw(seed), motions(draw.bits() % 2 == 0 ? 40 : 400) {
    const double size = 2 * std::cbrt(static_cast<double>(motions.size()));
    const double horizon = draw.bits() % 3 == 0 ? 0.3 : 1e9;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      for (double& x : motions[i].position) x = draw.uniform(0, size);
      motions[i].radius = draw.uniform(0.2, 0.9);
      if (i % 4 == 0) {
        statics.insert(world.add_static(motions[i]).index);
        continue;
      }
      world.add();
      spin.push_back(draw.uniform(-1, 1));
      if (i % 4 == 1) spin.back() = 0;
      while (spin.size() <= i) spin.push_back(spin.back());
      expires = horizon;
    }
  }
  Motion at(BodyIndex body, double time) const {
    Motion motion = motions[body];
    if (statics.count(body) != 0 || spin[body] == 0) return motion;
    const double w = spin[body], r = 3;
    motion.position[0] += r * std::cos(w * time), motion.position[1] += r * std::sin(w * time);
    motion.velocity = {-w * r * std::sin(w * time), w * r * std::cos(w * time), 0};
    motion.acceleration = w * w * r * 1.000001, motion.drift = 1e-9;
    motion.expiry = expires < 1e9 ? expires * (std::floor(time / expires) + 1) : expires;
    return motion;
  }
  Pairs touching(double time) const {
    Pairs pairs;
    for (BodyIndex a = 0; a < motions.size(); ++a) {
      for (BodyIndex b = a + 1; b < motions.size(); ++b) {
        if (statics.count(a) != 0 && statics.count(b) != 0) continue;
        const Motion one = at(a, time), other = at(b, time);
        long double square = 0;
        for (std::size_t d = 0; d < 3; ++d) {
          const long double x = static_cast<long double>(one.position[d]) - other.position[d];
          square += x * x;
        }
        const long double reach = static_cast<long double>(one.radius) + other.radius;
        if (square <= reach * reach) pairs.insert({a, b});
      }
    }
    return pairs;
  }

  test::SplitMix draw;
  std::vector<Motion> motions;
  std::vector<double> spin;
  std::set<BodyIndex> statics;
  double expires = 1e9;
  BroadPhase world{[this](double time, std::span<const BodyIndex> asked, std::span<Motion> answers) {
                     for (std::size_t i = 0; i < asked.size(); ++i) answers[i] = at(asked[i], time);
                   },
                   {.time_step = kStep}};
};

TEST(SkipTo, LeavesOutAllStepsButTheLastOne) {
  for (std::uint64_t i = 0; i < 12 * orchard::test::more(); ++i) {
    Paused paused(orchard::test::first_seed() + i);
    std::int64_t step = 0;
    for (int k = 0; k < 12; ++k) {
      const double time = static_cast<double>(step) * kStep;
      const std::uint64_t asked = paused.world.motions_asked();
      const bool within = k % 4 == 3;
      Advance now = within ? paused.world.advance(time, Budget{.work = 7}) : paused.world.advance(time);
      const Pairs truth = paused.touching(time), found = now.time <= time + 1e-9 ? pairs_of(now) : Pairs{};
      if (within) {
        for (const auto& pair : found) ASSERT_TRUE(truth.count(pair) != 0);
      } else {
        ASSERT_EQ(found, truth) << "seed " << i << ", step " << step;
      }
      ASSERT_LE(paused.world.motions_asked() - asked, 100 * paused.motions.size());
      const auto pause = 1 + static_cast<std::int64_t>(std::exp(paused.draw.uniform(0, 12)));
      if (k % 3 == 1) paused.world.cancel(paused.world.id_of(1));
      paused.world.skip_to(static_cast<double>(step + pause) * kStep);
      if (k % 3 == 2) paused.world.cancel(paused.world.id_of(2));
      step += pause;
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
