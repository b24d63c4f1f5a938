#include "support/corpus.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <iterator>

namespace orchard::test {

namespace fs = std::filesystem;

std::vector<std::pair<std::string, Bytes>> corpus(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry);
  std::ranges::sort(files);
  std::vector<std::pair<std::string, Bytes>> result;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    result.emplace_back(file.filename().string(), Bytes(std::istreambuf_iterator<char>(stream), {}));
  }
  return result;
}

Bytes damaged(Bytes bytes, Random& random) {
  for (std::uint64_t edits = 1 + random.below(3); edits > 0 && !bytes.empty(); --edits) {
    const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random.below(bytes.size()));
    switch (random.below(3)) {
      case 0:
        *at = random.below(2) == 0 ? static_cast<std::uint8_t>(random.bits()) : bytes[random.below(bytes.size())];
        break;
      case 1:
        bytes.erase(at);
        break;
      default:
        bytes.insert(at, bytes[random.below(bytes.size())]);
    }
  }
  return bytes;
}

}  // namespace orchard::test
