#include <gtest/gtest.h>

#include "any_broad_phase.h"
#include "runtime/numbers.h"
#include "worlds.h"

// Pairs that are none. (sequence_test.cpp has all changes of filters, by every method, against comparing all.)
namespace orchard::runtime {
namespace {

using test::kStep;

TEST(BodyFilters, GoByCategoriesMasksAndGroups) {
  const BodyFilter all{}, player{2, 1 | 4}, wall{1, 2}, ghost{8, 0};
  EXPECT_TRUE(may_pair(all, all));
  EXPECT_TRUE(may_pair(player, wall));
  EXPECT_FALSE(may_pair(player, player));  // 2 is not in its mask
  EXPECT_FALSE(may_pair(wall, all));       // one of the two masks is enough to exclude
  EXPECT_FALSE(may_pair(ghost, all));
  EXPECT_FALSE(may_pair(all, ghost));
  const auto in_group = [](BodyFilter filter, std::int32_t group) {
    filter.group = group;
    return filter;
  };
  EXPECT_FALSE(may_pair(in_group(all, -3), in_group(all, -3)));
  EXPECT_TRUE(may_pair(in_group(all, -3), in_group(all, -4)));
  EXPECT_TRUE(may_pair(in_group(all, -3), in_group(all, 3)));
  EXPECT_TRUE(may_pair(in_group(ghost, 5), in_group(wall, 5)));
  EXPECT_FALSE(may_pair(in_group(ghost, 5), in_group(wall, 6)));
}

// Bodies of three spheres each, in a row: the spheres of a body overlap all the time.
struct Triples {
  std::vector<Motion> values;
  BroadPhase world;
  explicit Triples(std::size_t bodies, bool grouped, const test::AnyOptions& options)
      : world(test::make_broad_phase(values_of(values), options)) {
    for (std::size_t i = 0; i < 3 * bodies; ++i) {
      const std::size_t which = i / 3;
      const double body = static_cast<double>(which), part = static_cast<double>(i % 3);
      values.push_back({.position = {10 * body + part, 0, 0}, .radius = 1, .acceleration = 0.1});
      world.add(0, {.group = grouped ? -1 - static_cast<std::int32_t>(i / 3) : 0});
    }
  }
};

TEST(BodyFilters, LetABodyOfSeveralSpheresSleep) {
  for (const test::AnyMethod method : test::kMethods) {
    for (const std::size_t bodies : {5u, 200u}) {
      if (method != test::AnyMethod::events && bodies > 5) continue;
      Triples w(bodies, true, {.method = method, .common = {.time_step = kStep}});
      Advance now = w.world.advance(0);
      EXPECT_TRUE(now.pairs.empty());
      EXPECT_GT(now.time, 0.3);  // until when no two bodies can meet
      const std::uint64_t asked = w.world.motions_asked();
      EXPECT_LE(asked, 2 * w.values.size());
      EXPECT_TRUE(w.world.advance(now.time - 0.02).pairs.empty());
      EXPECT_EQ(w.world.motions_asked(), asked);
      // A neighbour that comes near is a pair with each part that it touches.
      w.values[3].position = {4, 0, 0};
      w.world.teleport(w.world.id_of(3));
      now = w.world.advance(now.time);
      const BodyPair expected[] = {{2, 3}};
      EXPECT_TRUE(std::equal(now.pairs.begin(), now.pairs.end(), std::begin(expected), std::end(expected)));
    }
  }
  Triples awake(5, false, {.common = {.time_step = kStep}});
  EXPECT_EQ(awake.world.advance(0).pairs.size(), 15u);
}

TEST(BodyFilters, LeaveStaticBodiesOut) {
  for (const test::AnyMethod method : test::kMethods) {
    std::vector<Motion> values(3);
    for (Motion& motion : values) motion.radius = 1;
    BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = kStep}});
    const BodyId a = world.add();
    world.add();
    world.add_static(values[2], 0, {.ignores_static = true});  // no static one has pairs with static ones anyway
    EXPECT_EQ(world.advance(0).pairs.size(), 3u);
    EXPECT_TRUE(world.set_filter(a, {.ignores_static = true}));
    const Advance now = world.advance(kStep);
    const BodyPair expected[] = {{0, 1}, {1, 2}};
    EXPECT_TRUE(std::equal(now.pairs.begin(), now.pairs.end(), std::begin(expected), std::end(expected)));
    EXPECT_TRUE(world.set_filter(a, {}));
    EXPECT_EQ(world.advance(2 * kStep).pairs.size(), 3u);
  }
}

// 300 bodies of three spheres that cross each other's paths: what is asked for is what two bodies near each other need,
// next to nothing beside what the parts would cost each other.
TEST(BodyFilters, ExcludedPairsCostNothingAtLaterSteps) {
  const test::MovingBodies bodies({.bodies = 300, .ball = 80, .max_acceleration = 1, .end = 1}, 5);
  const MotionSource source = [&](double time, std::span<const BodyIndex> asked, std::span<Motion> motions) {
    for (std::size_t i = 0; i < asked.size(); ++i) {
      motions[i] = bodies.motion(asked[i] / 3, time);
      motions[i].position[0] += 0.5 * (asked[i] % 3);
    }
  };
  std::array<std::uint64_t, 2> asked{};
  std::array<std::vector<BodyPair>, 2> found;
  for (const bool grouped : {false, true}) {
    BroadPhase world(source, {.time_step = kStep});
    for (std::int32_t i = 0; i < 900; ++i) world.add(0, {.group = grouped ? -1 - i / 3 : 0});
    for (int step = 0; step < 90; ++step) {
      for (const BodyPair& pair : world.advance(kStep * step).pairs) {
        if (pair.a / 3 != pair.b / 3) found[grouped].push_back(pair);
      }
    }
    asked[grouped] = world.motions_asked();
  }
  EXPECT_EQ(found[0], found[1]);
  EXPECT_FALSE(found[1].empty());
  EXPECT_LT(2 * asked[1], asked[0]);
}

TEST(BodyFilters, TheApplicationsOwnIsAskedOnlyAboutNearBodies) {
  std::vector<Motion> values(400);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t two = i / 2;
    values[i].position = {3.0 * static_cast<double>(two), static_cast<double>(i % 2), 0};
    values[i].radius = 1;
  }
  BroadPhase world(values_of(values), {.time_step = kStep});
  for (std::size_t i = 0; i < values.size(); ++i) world.add();
  std::size_t asked = 0;
  world.set_pair_filter([&](BodyId a, BodyId b) {
    EXPECT_LT(a.index, b.index);
    ++asked;
    return a.index % 4 == 0 && b.index == a.index + 1;
  });
  EXPECT_EQ(world.advance(0).pairs.size(), 100u);
  EXPECT_LT(asked, 2000u);
  asked = 0;
  for (int step = 1; step < 50; ++step) EXPECT_EQ(world.advance(kStep * step).pairs.size(), 100u);
  EXPECT_LT(asked, 2000u);
  world.set_pair_filter(nullptr);
  EXPECT_EQ(world.advance(0.5).pairs.size(), 200u);
}

TEST(BodyFilters, ChangeFromTheNextStepOn) {
  for (const test::AnyMethod method : test::kMethods) {
    std::vector<Motion> values(2);
    for (Motion& motion : values) motion.radius = 1;
    BroadPhase world = test::make_broad_phase(values_of(values), {.method = method, .common = {.time_step = kStep}});
    const BodyId a = world.add(), b = world.add_static(values[1]);
    EXPECT_EQ(world.advance(0).pairs.size(), 1u);
    EXPECT_TRUE(world.set_filter(b, {.group = -1}));
    EXPECT_EQ(world.advance(kStep).pairs.size(), 1u);
    EXPECT_TRUE(world.set_filter(a, {.group = -1}));
    EXPECT_EQ(world.advance(2 * kStep).pairs.size(), 0u);
    EXPECT_TRUE(world.remove(a));
    EXPECT_FALSE(world.set_filter(a, {}));
    EXPECT_EQ(world.filter_of(a), BodyFilter{});
    const BodyId next = world.add();
    EXPECT_EQ(next.index, a.index);
    EXPECT_EQ(world.filter_of(next), BodyFilter{});  // not its predecessor's
    EXPECT_EQ(world.advance(3 * kStep).pairs.size(), 1u);
  }
}

}  // namespace
}  // namespace orchard::runtime
