#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "oracles.h"
#include "support/effort.h"
#include "worlds.h"

// Worlds without an extent along an axis, and such with far larger ones than their clusters have.
namespace orchard::runtime {
namespace {

constexpr double kOddStep = 0.01;
constexpr double kThin = 1e-9;  // bodies stay where they are along such an axis

struct Cost {
  std::uint64_t asked = 0;
  std::size_t bytes = 0;
};

// Of 40 steps, each of which is compared with the slow answer. `place` takes what is drawn.
Cost cost_of(std::size_t bodies, double radius, double speed, std::uint64_t seed,
             const std::function<Vec3(test::Draw&)>& place) {
  test::Draw draw(seed);
  std::vector<Motion> motions(bodies);
  BroadPhase world(values_of(motions), {.time_step = kOddStep});
  for (Motion& motion : motions) {
    motion.radius = radius;
    motion.velocity = draw.in_ball(speed);
    motion.position = place(draw);
    for (std::size_t d = 0; d < 3; ++d) motion.velocity[d] *= std::fabs(motion.position[d]) < kThin ? 0 : 1;
    world.add();
  }
  Cost cost;
  for (int step = 0; step < 40; ++step) {
    const Advance now = world.advance(kOddStep * step);
    EXPECT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), test::touching_pairs(motions)) << step;
    cost.bytes = std::max(cost.bytes, world.memory_bytes());
    for (Motion& motion : motions) motion.position = motion.position + kOddStep * motion.velocity;
  }
  cost.asked = world.motions_asked();
  return cost;
}

TEST(OddWorlds, WithoutAnExtentAlongAnAxisCostNoMoreThanThinOnes) {
  for (std::uint64_t seed = orchard::test::first_seed(); seed < orchard::test::first_seed() + orchard::test::more();
       ++seed) {
    const auto of = [&](double y, double z) {
      return cost_of(3000, 1e-5, 0.01, seed, [&](test::Draw& draw) -> Vec3 {
        return {draw.uniform(-1, 1), y * draw.uniform(-1, 1), z * draw.uniform(-1, 1)};
      });
    };
    EXPECT_LE(of(1, 0).asked, 2 * of(1, kThin).asked);
    EXPECT_LE(of(0, 0).asked, 5 * of(kThin, kThin).asked);  // on a line it depends on the draw
  }
}

// At most once, where the sample does not show the cluster, all of it is in one cell.
TEST(OddWorlds, FarLargerThanTheirClustersDoNotCompareAllWithAll) {
  constexpr std::size_t kBodies = 3000;
  for (std::uint64_t seed = orchard::test::first_seed(); seed < orchard::test::first_seed() + orchard::test::more();
       ++seed) {
    for (const double size : {1e-7, 1e-8}) {
      const Cost cost = cost_of(kBodies, 1e-12, 1e-13, seed, [&](test::Draw& draw) -> Vec3 {
        return (draw.uniform(0, 1) < 0.6 ? size : 1.0) * draw.in_ball(1);
      });
      EXPECT_LE(cost.asked, kBodies * kBodies / 2) << size;
      EXPECT_LE(cost.bytes, 2000 * kBodies) << size;
    }
  }
}

// A twentieth of the bodies is asked for at each step: what is planned when the others' bounds expire is for all.
TEST(OddWorlds, AreNotPlannedByTheFewBodiesThatAreCancelledAgainAndAgain) {
  const std::uint64_t first = orchard::test::first_seed();
  for (std::uint64_t seed = first; seed < first + 3 * orchard::test::more(); ++seed) {
    const test::MovingBodies bodies({.bodies = 2000, .ball = 250, .end = 2}, seed);
    BroadPhase world(bodies.source(), {.time_step = kOddStep});
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < bodies.size(); ++i) ids.push_back(world.add());
    std::size_t before = 0, most = 0;  // bytes
    for (int step = 0; step <= 110; ++step) {
      for (std::size_t i = 0; step > 0 && i < ids.size(); i += 20) world.cancel(ids[i]);
      world.advance(kOddStep * step);
      if (step == 90) before = world.memory_bytes();
      most = std::max(most, world.memory_bytes());
    }
    EXPECT_LT(static_cast<double>(most), 1.3 * static_cast<double>(before)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace orchard::runtime
