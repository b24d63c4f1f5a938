#include <gtest/gtest.h>

#include "any_broad_phase.h"
#include "support/effort.h"
#include "worlds.h"

// Steps far from time 0, where two of them are apart by a time step to three digits only: nothing is missed, and no
// step is answered twice.
namespace orchard::runtime {
namespace {

constexpr double kFarStep = 0.01;
constexpr double kSinceThe1970s = 1.7e9;  // seconds

std::vector<double> starts() {
  std::vector<double> all = {0, kSinceThe1970s};
  for (const double share : {0.1, 0.5, 0.9, 0.99}) all.push_back(share * kMaxSteps * kFarStep);
  for (std::size_t i = all.size(); i-- > 1;) all.push_back(-all[i]);
  return all;
}

// Two spheres come together in the last moment before a step, or in the first one after it.
TEST(FarTimes, TouchesAtTheMomentOfAStepAreNotMissed) {
  constexpr int kSteps = 12;
  const std::uint64_t first = orchard::test::first_seed(), count = 400 * orchard::test::more();
  for (const double start : starts()) {
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
      test::Draw draw(seed);
      const int step = static_cast<int>(2 + draw.bits() % 8);
      const double contact = start + kFarStep * step - start + kFarStep * draw.uniform(-5e-4, 5e-4), speed = 3;
      const auto state = [&](BodyIndex body, double time) {
        Motion motion;
        motion.radius = 0.5;
        if (body == 1)
          motion.position = {1 + (contact - (time - start)) * speed, 0, 0}, motion.velocity = {-speed, 0, 0};
        return motion;
      };
      const MotionSource source = [&](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
        for (std::size_t i = 0; i < bodies.size(); ++i) motions[i] = state(bodies[i], time);
      };
      BroadPhase world(source, {.time_step = kFarStep, .start = start});
      world.add(), world.add();
      for (int k = 0; k < kSteps; ++k) {
        const double time = start + kFarStep * k;
        const Advance now = world.advance(time);
        ASSERT_EQ(!now.pairs.empty(), spheres_touch(state(0, time), state(1, time))) << start << " " << seed;
        if (!now.pairs.empty()) {
          ASSERT_EQ(now.time, time);
        }
      }
    }
  }
}

TEST(FarTimes, AChangeCountsFromTheNextStep) {
  for (const double start : starts()) {
    std::vector<Motion> values(2);
    for (Motion& motion : values) motion.radius = 1;
    BroadPhase world(values_of(values), {.time_step = kFarStep, .start = start});
    const BodyId body = world.add();
    world.add();
    for (int k = 0; k < 200; ++k) {
      const Advance now = world.advance(start + kFarStep * k);
      ASSERT_EQ(now.pairs.size(), 1u) << start;
      ASSERT_EQ(now.time, start + kFarStep * k) << start << ": a step that has been answered before";
      ASSERT_TRUE(world.cancel(body));
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
