#include <gtest/gtest.h>

#include <set>

#include "worlds.h"

// Which bodies there are: ids, and worlds that are emptied and filled again.
namespace orchard::runtime {
namespace {

constexpr double kStep = 0.01;

constexpr BroadPhaseMethod kMethods[] = {
    BroadPhaseMethod::events, BroadPhaseMethod::all_pairs, BroadPhaseMethod::projection, BroadPhaseMethod::subdivision,
    BroadPhaseMethod::hybrid, BroadPhaseMethod::quadratic, BroadPhaseMethod::horns};

TEST(BodyIds, OfBodiesRemovedAreRefusedForGood) {
  BroadPhase world({}, {});
  std::vector<BodyId> ids;
  for (int i = 0; i < 5; ++i) ids.push_back(world.add_static(Motion{}));
  EXPECT_TRUE(world.remove(ids[3]));
  EXPECT_FALSE(world.remove(ids[3]));  // twice
  EXPECT_EQ(world.size(), 4u);
  EXPECT_EQ(world.id_of(3), kNoBody);
  const BodyId next = world.add_static(Motion{}), after = world.add_static(Motion{});
  EXPECT_EQ(next.index, 3u);  // again, for another body
  EXPECT_EQ(after.index, 5u);
  EXPECT_NE(next, ids[3]);
  EXPECT_EQ(world.id_of(3), next);
  EXPECT_FALSE(world.contains(ids[3]));
  EXPECT_FALSE(world.remove(ids[3]));
  EXPECT_FALSE(world.cancel(ids[3]));
  EXPECT_FALSE(world.set_importance(ids[3], 7));
  EXPECT_FALSE(world.move_static(ids[3], Motion{}));
  EXPECT_TRUE(world.contains(next));
  EXPECT_EQ(world.size(), 6u);
}

TEST(BodyIds, ThatNeverWereAreRefused) {
  std::vector<Motion> values(8);
  BroadPhase world(values_of(values), {});
  const auto refused = [&](BodyId id) {
    return !world.remove(id) && !world.cancel(id) && !world.teleport(id) && !world.set_importance(id, 1) &&
           !world.move_static(id, Motion{}) && !world.contains(id);
  };
  EXPECT_TRUE(refused(kNoBody));  // of an empty world
  EXPECT_TRUE(refused(BodyId{0, 0}));
  const BodyId moving = world.add();
  for (const BodyId id : {kNoBody, BodyId{1'000'000, 1}, BodyId{1, 1}, BodyId{0, 0}, BodyId{0, 2}, BodyId{0, 3},
                          BodyId{0xfffffffeu, 1}, BodyId{0xffffffffu, 1}}) {
    EXPECT_TRUE(refused(id)) << id.index << " " << id.generation;
  }
  EXPECT_FALSE(world.move_static(moving, Motion{}));  // it is not static
  EXPECT_TRUE(world.advance(0).pairs.empty());
  EXPECT_TRUE(world.remove(moving));
  EXPECT_TRUE(refused(moving));
}

TEST(BodyIds, AreNeverGivenTwice) {
  BroadPhase world({}, {});
  std::set<std::pair<BodyIndex, std::uint32_t>> given;
  std::vector<BodyId> now;
  test::Draw draw(1);
  for (int i = 0; i < 20000; ++i) {
    if (now.empty() || draw.uniform(0, 1) < 0.5) {
      now.push_back(world.add_static(Motion{}));
      ASSERT_TRUE(given.emplace(now.back().index, now.back().generation).second);
    } else {
      const std::size_t which = draw.bits() % now.size();
      ASSERT_TRUE(world.remove(now[which]));
      now.erase(now.begin() + static_cast<std::ptrdiff_t>(which));
    }
    ASSERT_EQ(world.size(), now.size());
  }
}

}  // namespace
}  // namespace orchard::runtime
