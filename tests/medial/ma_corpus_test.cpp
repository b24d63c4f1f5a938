#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "../fuzz/ma_entry.h"
#include "orchard/geometry/random.h"

namespace orchard {
namespace {

using Bytes = std::vector<std::uint8_t>;

// In the order of their names.
std::vector<std::pair<std::string, Bytes>> corpus() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(ORCHARD_FUZZ_CORPUS)) files.push_back(entry);
  std::ranges::sort(files);
  std::vector<std::pair<std::string, Bytes>> result;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    result.emplace_back(file.filename().string(), Bytes(std::istreambuf_iterator<char>(stream), {}));
  }
  return result;
}

TEST(MaCorpus, GivesAMedialMeshOrAnInputError) {
  int accepted = 0;
  for (const auto& [name, bytes] : corpus())
    EXPECT_NO_THROW(accepted += test::read_ma_bytes(bytes.data(), bytes.size())) << name;
  EXPECT_GE(accepted, 4);
}

TEST(MaCorpus, SurvivesBeingCutAnywhere) {
  for (const auto& [name, bytes] : corpus()) {
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
      ASSERT_NO_THROW(test::read_ma_bytes(cut.data(), cut.size())) << name << " at " << size;
    }
  }
}

TEST(MaCorpus, SurvivesRandomDamage) {
  std::uint64_t item = 0;
  for (const auto& [name, bytes] : corpus()) {
    for (int trial = 0; trial < 500; ++trial) {
      Random random(1, 2, item++);
      Bytes damaged = bytes;
      for (std::uint64_t edits = 1 + random.below(3); edits > 0 && !damaged.empty(); --edits) {
        const auto at = damaged.begin() + static_cast<std::ptrdiff_t>(random.below(damaged.size()));
        switch (random.below(3)) {
          case 0:
            *at =
                random.below(2) == 0 ? static_cast<std::uint8_t>(random.bits()) : damaged[random.below(damaged.size())];
            break;
          case 1:
            damaged.erase(at);
            break;
          default:
            damaged.insert(at, damaged[random.below(damaged.size())]);
        }
      }
      ASSERT_NO_THROW(test::read_ma_bytes(damaged.data(), damaged.size())) << name << " item " << item - 1;
    }
  }
}

}  // namespace
}  // namespace orchard
