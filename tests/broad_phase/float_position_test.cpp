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

// A crowd in floats, array by array, and as it is in motions.
struct FloatCrowd {
  std::array<std::vector<float>, 9> numbers;
  std::vector<double> expiry;
  MotionArrays arrays;
  std::vector<Motion> motions;

  explicit FloatCrowd(std::size_t bodies) : expiry(bodies), motions(bodies) {
    for (std::vector<float>& of : numbers) of.resize(bodies);
    arrays = {numbers[0], numbers[1], numbers[2], numbers[3], numbers[4],
              numbers[5], numbers[6], numbers[7], numbers[8], expiry};
  }
  void put(std::size_t i, const Motion& m) {
    for (std::size_t d = 0; d < 3; ++d) {
      numbers[d][i] = static_cast<float>(m.position[d]), numbers[3 + d][i] = static_cast<float>(m.velocity[d]);
    }
    numbers[6][i] = static_cast<float>(m.radius), numbers[7][i] = static_cast<float>(m.acceleration);
    numbers[8][i] = static_cast<float>(m.drift);
    expiry[i] = m.expiry;
    const auto number = [&](std::size_t k) { return static_cast<double>(numbers[k][i]); };
    motions[i] = {{number(0), number(1), number(2)},
                  {number(3), number(4), number(5)},
                  number(6),
                  number(7),
                  number(8),
                  {},
                  m.expiry};
  }
};

TEST(MotionArrays, AreAskedAndAnsweredAsTheSameMotionsAre) {
  constexpr std::size_t kBodies = 400;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    test::Draw draw(seed);
    const test::MovingBodies bodies({.bodies = kBodies, .ball = 20, .period = 0.3, .staggered = seed % 2 == 1}, seed);
    FloatCrowd crowd(kBodies);
    const BroadPhaseOptions options{.time_step = 0.01, .position_slack = float_slack(64)};
    BroadPhase of_arrays = BroadPhase::reading(crowd.arrays, options), of_motions(values_of(crowd.motions), options);
    for (std::size_t i = 0; i < kBodies; ++i) of_arrays.add(), of_motions.add();
    for (int step = 0; step < 100; ++step) {
      for (BodyIndex i = 0; i < kBodies; ++i) {
        Motion m = bodies.motion(i, 0.01 * step);
        m.drift = 0x1p-20 * (1 + length(m.velocity)), m.acceleration *= 1.001;  // for what is rounded
        crowd.put(i, m);
      }
      const Advance a = of_arrays.advance(0.01 * step), b = of_motions.advance(0.01 * step);
      const std::vector<BodyPair> found(a.pairs.begin(), a.pairs.end());
      ASSERT_EQ(found, std::vector<BodyPair>(b.pairs.begin(), b.pairs.end())) << "seed " << seed << ' ' << step;
      ASSERT_EQ(found, test::touching_pairs(crowd.motions)) << "seed " << seed << ' ' << step;
    }
    EXPECT_EQ(of_arrays.motions_asked(), of_motions.motions_asked());
  }
}

TEST(MotionArrays, MayBeLeftOutAndRefuseBodiesBeyondTheirEnd) {
  std::vector<float> x = {0, 1.5f, 9}, radius = {1, 1, 1};
  MotionArrays arrays{.x = x, .radius = radius};
  BroadPhase world = BroadPhase::reading(arrays);
  for (int i = 0; i < 4; ++i) world.add();
  Advance now = world.advance(0);
  EXPECT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), (std::vector<BodyPair>{{0, 1}}));
  EXPECT_EQ(std::vector<BodyIndex>(now.refused.begin(), now.refused.end()), (std::vector<BodyIndex>{3}));
  x.push_back(8), radius.push_back(1);
  arrays = {.x = x, .radius = radius};
  now = world.advance(0.01);
  EXPECT_EQ(std::vector<BodyPair>(now.pairs.begin(), now.pairs.end()), (std::vector<BodyPair>{{0, 1}, {2, 3}}));
  EXPECT_TRUE(now.refused.empty());
}

}  // namespace
}  // namespace orchard::runtime
