#include <gtest/gtest.h>

#include <cstring>
#include <regex>

#include "orchard/runtime/tree_file.h"
#include "values.h"

namespace orchard {
namespace {

// The only group of the first match in a file of the sources; empty if there is none.
std::string found_in(const std::string& file, const char* pattern) {
  const std::string text = test::bytes_of(std::filesystem::path(ORCHARD_SOURCE) / file);
  std::smatch match;
  return std::regex_search(text, match, std::regex(pattern)) ? match[1].str() : std::string();
}

// Without ParaView: the plugin is read, not run.
TEST(ParaViewPlugin, ReadsTheVersionThatTheProgramAndThePageHave) {
  const auto file = std::filesystem::path(ORCHARD_SOURCE) / "tests/fuzz/corpus/tree/l_shape.orchard";
  runtime::PackedSphereTree tree;
  ASSERT_EQ(runtime::load_file(file.c_str(), tree), runtime::LoadStatus::ok);
  const std::vector<std::byte> bytes = runtime::serialize(tree);
  std::uint32_t version = 0, header = 0;
  std::memcpy(&version, bytes.data() + 8, sizeof version);
  std::memcpy(&header, bytes.data() + 12, sizeof header);
  const std::string number = std::to_string(version);
  EXPECT_EQ(found_in("viz/paraview/orchard_reader.py", "MAGIC, VERSION, BLOCK_BYTES, LEAF = [^,]*, ([0-9]+),"), number);
  EXPECT_EQ(found_in("docs/reference/formats.md", "used in place by `view` and\n`MappedTree`. Version ([0-9]+)\\."),
            number);
  EXPECT_EQ(found_in("docs/reference/formats.md", "u32 \\| version: ([0-9]+) \\|"), number);
  EXPECT_EQ(found_in("docs/reference/formats.md", "the version is above ([0-9]+);"), number);
  EXPECT_EQ(found_in("docs/reference/formats.md", "header size: ([0-9]+)"), std::to_string(header));
  EXPECT_EQ(found_in("viz/paraview/orchard_reader.py", "len\\(data\\) < ([0-9]+) or"), std::to_string(header));
  EXPECT_EQ(found_in("viz/paraview/orchard_reader.py", "LEAF = [^,]*, [0-9]+, ([0-9]+),"),
            std::to_string(sizeof(runtime::SiblingBlock)));
}

}  // namespace
}  // namespace orchard
