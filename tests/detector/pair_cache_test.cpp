#include "detector/pair_cache.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support.h"
#include "support/effort.h"

// The detector's table of pairs, by itself.
namespace orchard::runtime::detail {
namespace {

struct ModelPair {
  std::uint32_t generation = 0, mark = 0;
  bool held = false, record = false;
};

// Pairs come, go, are replaced or kept, as a map would have it; what is remembered of each stays with it.
TEST(PairCache, RemembersOfEachPairWhatAMapWould) {
  for (std::uint64_t seed = 0; seed < 100 * orchard::test::more(); ++seed) {
    test::Draw draw(orchard::test::first_seed() + seed);
    PairCache table;
    std::map<BodyPair, ModelPair> model;
    std::map<BodyIndex, std::uint32_t> generations;
    const auto generation_of = [&](const BodyPair& pair) { return generations[pair.a] + generations[pair.b]; };
    std::uint32_t marks = 0;
    for (int step = 0; step < 30; ++step) {
      std::set<BodyIndex> replaced;
      for (std::uint64_t k = draw.bits() % 3; k > 0; --k) {
        const auto body = static_cast<BodyIndex>(draw.bits() % 20);
        if (replaced.insert(body).second) ++generations[body];
      }
      std::set<BodyPair> now;
      for (const auto& [pair, known] : model) {
        if (draw.bits() % 8 != 0) now.insert(pair);
      }
      for (std::uint64_t k = draw.bits() % 20; k > 0; --k) {
        const auto a = static_cast<BodyIndex>(draw.bits() % 20), b = static_cast<BodyIndex>(draw.bits() % 20);
        if (a != b) now.insert({std::min(a, b), std::max(a, b)});
      }
      const auto lasts = [&](const BodyPair& pair) {
        return pair.a % 2 == 0 && !replaced.contains(pair.a) && !replaced.contains(pair.b);
      };
      std::map<BodyPair, ModelPair> expected;
      std::vector<BodyPair> kept, gone_expected, gone;
      for (const auto& [pair, known] : model) {
        const bool same = known.generation == generation_of(pair);
        if (now.contains(pair) && same) {
          expected[pair] = known;
          continue;
        }
        if (known.held) gone_expected.push_back(pair);
        if (now.contains(pair) || !known.held || !lasts(pair)) continue;
        expected[pair] = known;
        kept.push_back(pair);
      }
      for (const BodyPair& pair : now) expected.try_emplace(pair, ModelPair{generation_of(pair)});
      const std::vector<BodyPair> pairs(now.begin(), now.end());
      table.match(
          pairs, [&](std::size_t place) { return table.known(place).generations == generation_of(table.pair(place)); },
          [&](const PairCache::Known& known) {
            gone.push_back(known.pair);
            EXPECT_EQ(known.clearance.changes, model[known.pair].mark);
            return lasts(known.pair);
          },
          generation_of);
      ASSERT_EQ(gone, gone_expected);
      ASSERT_EQ(table.size(), expected.size());
      ASSERT_EQ(table.kept().size(), kept.size());
      for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(table.pair(table.kept()[i]), kept[i]);
      std::size_t place = 0;
      for (auto& [pair, known] : expected) {
        ASSERT_EQ(table.pair(place), pair);
        auto& of = table.known(place);
        ASSERT_EQ(of.pair, pair);
        ASSERT_EQ(of.generations, known.generation);
        ASSERT_EQ(of.record != kNoRecord, known.record);
        ASSERT_EQ(table.busy(place), known.held);
        if (known.mark != 0) {
          ASSERT_EQ(of.clearance.changes, known.mark);
        }
        if (known.record) {
          ASSERT_EQ(table[of.record].turn.waited, known.mark);
        }
        if (!known.record && draw.bits() % 2 == 0) {
          table.take(place);
          ASSERT_EQ(table[of.record].answered, -1);
          ASSERT_EQ(table[of.record].turn.waited, 0u);
          known.record = true;
        }
        known.mark = of.clearance.changes = ++marks;
        if (known.record) table[of.record].turn.waited = known.mark;
        known.held = known.record && draw.bits() % 2 == 0;
        table.tell(place++, known.held);
      }
      model = expected;
    }
  }
}

}  // namespace
}  // namespace orchard::runtime::detail
