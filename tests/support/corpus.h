#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "orchard/geometry/random.h"

// The fuzzers' files, for tests that every reader survives them, whole, cut and damaged.
namespace orchard::test {

using Bytes = std::vector<std::uint8_t>;

// The name and the content of each file of a folder, in the order of the names.
std::vector<std::pair<std::string, Bytes>> corpus(const std::filesystem::path& folder);

// The bytes after one to three random edits: a byte replaced by any or by another one of the file, taken out, or put
// in.
Bytes damaged(Bytes bytes, Random& random);

}  // namespace orchard::test
