#include <gtest/gtest.h>

#include <set>

#include "broad_phase/overlap_list.h"
#include "broad_phase/swept_grid.h"
#include "broad_phase/timing_wheel.h"
#include "worlds.h"

// What the default broad phase keeps between steps, by itself.
namespace orchard::runtime::detail {
namespace {

TEST(OverlapList, IsTheSetThatASetWouldBe) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    test::Draw draw(seed);
    const std::uint64_t bodies = 3 + draw.bits() % 60;
    const auto body = [&] { return static_cast<BodyIndex>(draw.bits() % bodies); };
    OverlapList list;
    list.make_room(bodies);
    std::set<BodyPair> expected;
    for (int step = 0; step < 30; ++step) {
      const bool rebuild = draw.bits() % 8 == 0;
      if (rebuild) list.start_over(), expected.clear();
      std::set<BodyPair> added, dropped;
      std::set<BodyIndex> updated, refused;
      for (std::uint64_t k = draw.bits() % 3; k > 0; --k)
        list.mark(*updated.insert(body()).first, OverlapList::kUpdated);
      if (draw.bits() % 4 == 0) list.mark(*refused.insert(body()).first, OverlapList::kRefused);
      for (std::uint64_t k = draw.bits() % (rebuild ? 400 : 20); k > 0; --k) {
        const BodyIndex a = body(), b = body();
        if (a == b) continue;
        const BodyPair pair{std::min(a, b), std::max(a, b)};
        const bool adds = rebuild || draw.bits() % 2 == 0;
        adds ? list.add(pair) : list.drop(pair);
        (adds ? added : dropped).insert(pair);
      }
      std::erase_if(expected, [&](const BodyPair& pair) {
        return updated.contains(pair.a) || updated.contains(pair.b) || dropped.contains(pair);
      });
      expected.insert(added.begin(), added.end());
      std::erase_if(expected,
                    [&](const BodyPair& pair) { return refused.contains(pair.a) || refused.contains(pair.b); });
      list.update(bodies);
      const auto pairs = list.pairs();
      ASSERT_EQ(std::vector<BodyPair>(pairs.begin(), pairs.end()),
                std::vector<BodyPair>(expected.begin(), expected.end()))
          << "seed " << seed << " step " << step;
    }
  }
}

TEST(Rounds, AreComparedAcrossTheEndOfTheirNumbers) {
  const Round last = (1u << kRoundBits) - 1;
  EXPECT_TRUE(is_later(2, 1));
  EXPECT_FALSE(is_later(1, 1));
  EXPECT_FALSE(is_later(1, 2));
  EXPECT_TRUE(is_later(last + 1, last));
  EXPECT_TRUE(is_later(last + 3, PairEvent({0, 1}, last).created));
  EXPECT_FALSE(is_later(last - 3, PairEvent({0, 1}, last + 2).created));
}

TEST(PackedAabb, IsTheWholeBoxUpToFourCells) {
  test::Draw draw(2);
  BoxBlock block;
  std::array<BodyIndex, kBlock> ids;
  std::array<QuantizedAabb, kBlock> boxes;
  for (std::size_t i = 0; i < kBlock; ++i) {
    ids[i] = static_cast<BodyIndex>(kBlock - 1 - i);
    for (std::size_t d = 0; d < 3; ++d) {
      const auto lower = static_cast<std::uint32_t>(draw.uniform(0, kLastQuantum - 300.0));
      const std::uint32_t longest = kMaxCellsPerAxis * kQuanta - 1 - lower % kQuanta;
      boxes[i].lower[d] = lower;
      boxes[i].upper[d] = lower + (i % 2 == 0 ? longest : static_cast<std::uint32_t>(draw.uniform(0, longest)));
    }
    block.set(i, boxes[i]);
  }
  for (const std::size_t count : {kBlock, kBlock - 1, std::size_t{3}}) {
    std::vector<PackedAabb> narrow(kBlock);
    block.store(std::span(ids).first(count), narrow);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(narrow[ids[i]].whole().lower, boxes[i].lower);
      EXPECT_EQ(narrow[ids[i]].whole().upper, boxes[i].upper);
    }
  }
}

TEST(SweptGrid, SharesNoLineBetweenCellsOfABox) {
  constexpr auto kMaxOffset = static_cast<int>(kMaxCellsPerAxis) - 1;
  for (unsigned bits = kMinLineBits; bits <= kMaxLineBits; ++bits) {
    const std::array<std::uint32_t, 3> factors = line_factors(bits);
    const std::uint32_t mask = (1u << bits) - 1;
    for (int z = 0; z <= kMaxOffset; ++z) {
      for (int y = -kMaxOffset; y <= kMaxOffset; ++y) {
        for (int x = -kMaxOffset; x <= kMaxOffset; ++x) {
          const std::uint32_t line = static_cast<std::uint32_t>(x) * factors[0] +
                                     static_cast<std::uint32_t>(y) * factors[1] +
                                     static_cast<std::uint32_t>(z) * factors[2];
          ASSERT_EQ((line & mask) == 0, x == 0 && y == 0 && z == 0) << bits;
        }
      }
    }
  }
}

// As many lines are read for each entry, however long and thin the world is: a rebuild takes time in proportion.
TEST(SweptGrid, SpreadsWorldsOfAnyShapeEvenly) {
  constexpr std::size_t kBodies = 320 * kBlock;
  const std::array<double, 3> shapes[] = {{27, 27, 27}, {141, 141, 1}, {1, 141, 141}, {20000, 1, 1}, {1, 1, 20000}};
  for (const std::array<double, 3>& cells : shapes) {
    test::Draw draw(1);
    SweptGrid grid;
    grid.reset(kBodies / 2, {});
    SweptGrid::Visits visits;
    GridCounts counts;
    std::vector<PackedAabb> boxes(kBodies);
    std::vector<BodyPair> pairs;
    for (BodyIndex begin = 0; begin < kBodies; begin += kBlock) {
      BoxBlock block;
      std::array<BodyIndex, kBlock> ids;
      for (std::size_t i = 0; i < kBlock; ++i) {
        ids[i] = begin + static_cast<BodyIndex>(i);
        QuantizedAabb box{};
        for (std::size_t d = 0; d < 3; ++d) {
          const auto lower = static_cast<std::uint32_t>((1000 + draw.uniform(0, cells[d])) * kQuanta);
          box.lower[d] = lower, box.upper[d] = lower + kQuanta / 4;
        }
        boxes[ids[i]] = PackedAabb(box);
        block.set(i, box);
      }
      visits.clear();
      grid.encode(ids, block, visits);
      grid.insert(visits.visits(), boxes, pairs, counts);
    }
    EXPECT_LT(static_cast<double>(counts.lines_read), 1.5 * static_cast<double>(counts.entries)) << cells[0];
  }
}

}  // namespace
}  // namespace orchard::runtime::detail
