// What floats make of motion that keeps its bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "any_broad_phase.h"
#include "oracles.h"
#include "orchard/runtime/motion_helpers.h"
#include "worlds.h"

namespace orchard::runtime {
namespace {

Vec3 rounded(const Vec3& v) {
  return {static_cast<double>(static_cast<float>(v[0])), static_cast<double>(static_cast<float>(v[1])),
          static_cast<double>(static_cast<float>(v[2]))};
}

// Slow, steady flight 5 km from the origin, positions given in float.
test::Misses far_away(double slack, std::uint64_t seeds, std::uint64_t first, test::AnyMethod method) {
  test::Misses trial;
  for (std::uint64_t seed = first; seed < first + seeds; ++seed) {
    test::Draw draw(seed);
    constexpr double kDt = 0.01, kFar = 5000;
    constexpr std::size_t kBodies = 12;
    std::vector<Motion> exact(kBodies), given;
    for (Motion& m : exact) {
      m.position = Vec3{kFar, -kFar, kFar} + draw.in_ball(1.5);
      m.velocity = draw.uniform(0, 0.1) * draw.direction();
      m.radius = draw.uniform(0.2, 0.6);
    }
    given = exact;
    BroadPhase world = test::make_broad_phase(
        values_of(given), {.method = method, .common = {.time_step = kDt, .position_slack = slack}});
    for (std::size_t i = 0; i < kBodies; ++i) world.add();
    for (int step = 0; step < 80; ++step) {
      for (std::size_t i = 0; i < kBodies; ++i) given[i].position = rounded(exact[i].position);
      std::vector<BodyPair> expected;
      for (BodyIndex i = 0; i < kBodies; ++i) {
        for (BodyIndex j = i + 1; j < kBodies; ++j) {
          if (spheres_touch(given[i], given[j])) expected.push_back({i, j});
        }
      }
      const Advance now = world.advance(kDt * step);
      EXPECT_TRUE(std::includes(expected.begin(), expected.end(), now.pairs.begin(), now.pairs.end()) || slack == 0);
      trial.touching += expected.size();
      trial.missed += expected.size() - std::min(expected.size(), now.pairs.size());
      for (Motion& m : exact) m.position = m.position + kDt * m.velocity;
    }
  }
  return trial;
}

TEST(PositionSlack, IsWhatFloatPositionsFarAwayNeed) {
  for (const test::AnyMethod method :
       {test::AnyMethod::events, test::AnyMethod::all_pairs, test::AnyMethod::projection, test::AnyMethod::horns}) {
    const test::Misses trial = far_away(float_slack(5010), 60, 1, method);
    EXPECT_GT(trial.touching, 1000u);
    EXPECT_EQ(trial.missed, 0u) << static_cast<int>(method);
  }
  EXPECT_GT(far_away(0, 60, 1, test::AnyMethod::events).missed, 0u);
}

TEST(PositionSlack, HasToBeALength) {
  for (const double slack : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_FALSE(is_valid(BroadPhaseOptions{.position_slack = slack}));
  }
}

// Positions and velocities are floats from step to step.
TEST(KeptInFloat, CoversTheRoundingsOfEveryStep) {
  bool needed = false;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    test::Draw draw(seed);
    const float h = static_cast<float>(draw.uniform(0.002, 0.02));
    const double far = std::pow(10, draw.uniform(0, 5)), speed = draw.uniform(0, 20);
    Motion motion;
    std::array<float, 3> x{}, v{}, a{};
    for (std::size_t d = 0; d < 3; ++d) {
      x[d] = static_cast<float>(draw.uniform(-far, far));
      v[d] = static_cast<float>(draw.uniform(-speed, speed));
      a[d] = static_cast<float>(seed % 3 == 0 ? 0 : draw.uniform(-9, 9));
    }
    const auto wide = [](const std::array<float, 3>& f) { return Vec3{f[0], f[1], f[2]}; };
    motion.position = wide(x), motion.velocity = wide(v);
    motion.acceleration = length(wide(a));
    motion.drift = drift_of(Integrator::semi_implicit_euler, h, motion.acceleration);
    const Motion kept = kept_in_float(motion, h, far + 100, speed + 20);
    EXPECT_EQ(kept.half_space, Vec3{});
    for (int k = 1; k <= 100; ++k) {
      for (std::size_t d = 0; d < 3; ++d) {
        v[d] += h * a[d];
        x[d] += h * v[d];
      }
      const double s = static_cast<double>(h) * k;
      const double off = length(wide(x) - motion.position - s * motion.velocity);
      ASSERT_LE(off, kept.drift * s + kept.acceleration * s * s / 2 + 1e-12 * far) << seed;
      needed = needed || off > motion.drift * s + motion.acceleration * s * s / 2 + 1e-9 * far;
    }
  }
  EXPECT_TRUE(needed);
}

}  // namespace
}  // namespace orchard::runtime
