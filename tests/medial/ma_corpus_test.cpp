#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "../fuzz/ma_entry.h"
#include "orchard/geometry/random.h"
#include "support/corpus.h"

namespace orchard {
namespace {

using test::Bytes;

TEST(MaCorpus, GivesAMedialMeshOrAnInputError) {
  int accepted = 0;
  for (const auto& [name, bytes] : test::corpus(ORCHARD_FUZZ_CORPUS))
    EXPECT_NO_THROW(accepted += test::read_ma_bytes(bytes.data(), bytes.size())) << name;
  EXPECT_GE(accepted, 4);
}

TEST(MaCorpus, SurvivesBeingCutAnywhere) {
  for (const auto& [name, bytes] : test::corpus(ORCHARD_FUZZ_CORPUS)) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_NO_THROW(test::read_ma_bytes(cut.data(), cut.size())) << name << " at " << size;
    }
  }
}

TEST(MaCorpus, SurvivesRandomDamage) {
  std::uint64_t item = 0;
  for (const auto& [name, bytes] : test::corpus(ORCHARD_FUZZ_CORPUS)) {
    for (int trial = 0; trial < 500; ++trial) {
      Random random(1, 2, item++);
      const Bytes damaged = test::damaged(bytes, random);
      ASSERT_NO_THROW(test::read_ma_bytes(damaged.data(), damaged.size())) << name << " item " << item - 1;
    }
  }
}

}  // namespace
}  // namespace orchard
