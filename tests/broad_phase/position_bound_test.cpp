#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "orchard/runtime/broad_phase.h"
#include "runtime/numbers.h"
#include "worlds.h"

namespace orchard::runtime {
namespace {

using test::kStep;
constexpr double kPeriod = 0.1;
constexpr std::size_t kJumpingBodies = 24, kBoundSteps = 60, kPeriods = 7;

// Half of the bodies jump at will in a place that they leave for another one every kPeriod; the others fly straight.
struct JumpingBodies {
  explicit JumpingBodies(std::uint64_t seed) : draw(seed) {
    for (std::size_t i = 0; i < kJumpingBodies; ++i) {
      radii.push_back(draw.uniform(0.1, 0.5));
      reaches.push_back(draw.uniform(0.1, 1));
      starts.push_back(draw.in_ball(5));
      velocities.push_back(4 * draw.direction());
      for (std::size_t p = 0; p < kPeriods; ++p) places.push_back(draw.in_ball(5));
    }
  }
  bool jumps(std::size_t body) const { return body % 2 == 0; }
  Vec3 place(std::size_t body, std::size_t step) const {
    const auto period = static_cast<std::size_t>(static_cast<double>(step) * kStep / kPeriod + 1e-9);
    return places[body * kPeriods + period];
  }
  Vec3 position(std::size_t body, std::size_t step) {
    if (!jumps(body)) return starts[body] + (static_cast<double>(step) * kStep) * velocities[body];
    return place(body, step) + reaches[body] * draw.in_ball(1);
  }
  Motion motion(std::size_t body, std::size_t step) const {
    const double next = (std::floor(static_cast<double>(step) * kStep / kPeriod + 1e-9) + 1) * kPeriod;
    // A bound holds at its expiry, too, when the body is elsewhere already.
    if (jumps(body)) return position_bounded(place(body, step), reaches[body], radii[body], next - kStep / 2);
    Motion straight;
    straight.position = starts[body] + (static_cast<double>(step) * kStep) * velocities[body];
    straight.velocity = velocities[body];
    straight.radius = radii[body];
    return straight;
  }

  test::Draw draw;
  std::vector<double> radii, reaches;
  std::vector<Vec3> starts, velocities, places;
};

TEST(PositionBounds, MissNoContactOfBodiesThatJumpWithinTheirPlaces) {
  std::size_t contacts = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    JumpingBodies world(seed);
    BroadPhase broad_phase(
        [&](double time, std::span<const BodyIndex> bodies, std::span<Motion> motions) {
          const auto step = static_cast<std::size_t>(std::lround(time / kStep));
          for (std::size_t i = 0; i < bodies.size(); ++i) motions[i] = world.motion(bodies[i], step);
        },
        {.time_step = kStep});
    for (std::size_t i = 0; i < kJumpingBodies; ++i) broad_phase.add();
    for (std::size_t step = 0; step < kBoundSteps; ++step) {
      const Advance now = broad_phase.advance(static_cast<double>(step) * kStep);
      std::vector<Vec3> positions;
      for (std::size_t i = 0; i < kJumpingBodies; ++i) positions.push_back(world.position(i, step));
      for (BodyIndex i = 0; i < kJumpingBodies; ++i)
        for (BodyIndex j = i + 1; j < kJumpingBodies; ++j) {
          if (length(positions[i] - positions[j]) > world.radii[i] + world.radii[j]) continue;
          ++contacts;
          ASSERT_TRUE(std::find(now.pairs.begin(), now.pairs.end(), BodyPair{i, j}) != now.pairs.end())
              << "seed " << seed << ", step " << step << ", pair " << i << ' ' << j;
        }
    }
  }
  EXPECT_GT(contacts, 300u);
}

TEST(PositionBounds, AreBallsAtRestThatMeetNowOrNever) {
  const Motion door = position_bounded({0, 0, 0}, 1, 0.5, 10), lift = position_bounded({4, 0, 0}, 1, 0.5, 10);
  EXPECT_EQ(earliest_contact(door, lift, 10, 0), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(spheres_touch(door, lift));
  EXPECT_TRUE(spheres_touch(door, position_bounded({3, 0, 0}, 1, 0.5, 10)));  // they touch in one point
}

}  // namespace
}  // namespace orchard::runtime
