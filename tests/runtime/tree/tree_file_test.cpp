#include "orchard/runtime/tree_file.h"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "orchard/runtime/narrow_phase.h"
#include "support/query_of_trees.h"
#include "tree_file_support.h"

namespace orchard::runtime {
namespace {

#ifdef _WIN32
constexpr LoadStatus kStatusOfFolder = LoadStatus::cannot_open;  // folders are not opened as files there
#else
constexpr LoadStatus kStatusOfFolder = LoadStatus::read_failed;
#endif

using namespace orchard::runtime::test;

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::temp_directory_path() /
         ("orchard_" + std::to_string(reinterpret_cast<std::uintptr_t>(&name)) + "_" + name);
}

void write(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

TEST(TreeFile, GivesBackTheTreeThatWasSerialized) {
  const Mesh empty{};
  const std::vector<std::pair<const char*, PackedSphereTree>> cases = {
      {"one node", build_tree(box({0, 0, 0}, {1, 1, 1}), {.leaf_triangles = 100})},
      {"no triangles", build_tree(empty)},
      {"three levels", sample_tree()},
      {"more than eight children", build_tree(torus(16, 8, 1, 0.3), {.branching = 21})},
      {"soup", build_tree(soup(3, 200), {.branching = 2, .leaf_triangles = 1})},
  };
  for (const auto& [name, tree] : cases) {
    SCOPED_TRACE(name);
    ASSERT_EQ(structure_fault(tree), nullptr);
    const auto file = serialize(tree);
    EXPECT_EQ(file.size() % 64, 0u);
    PackedSphereTree loaded;
    ASSERT_EQ(load(file, loaded), LoadStatus::ok);
    EXPECT_EQ(loaded.origin, tree.origin);
    EXPECT_EQ(loaded.bounding_radius, tree.bounding_radius);
    EXPECT_EQ(loaded.branching, tree.branching);
    EXPECT_EQ(loaded.depth, tree.depth);
    EXPECT_EQ(loaded.node_count, tree.node_count);
    ASSERT_EQ(loaded.blocks.size(), tree.blocks.size());
    EXPECT_EQ(std::memcmp(loaded.blocks.data(), tree.blocks.data(), 224 * tree.blocks.size()), 0);
    EXPECT_EQ(loaded.vertices, tree.vertices);
    EXPECT_EQ(loaded.triangles, tree.triangles);
    EXPECT_EQ(loaded.leaf_triangles, tree.leaf_triangles);
  }
}

TEST(TreeFile, PutsEverySectionWhereTheFormatSays) {
  const PackedSphereTree tree = sample_tree();
  auto file = serialize(tree);
  EXPECT_EQ(std::memcmp(file.data(), "\x89ORCH\r\n\x1a", 8), 0);
  EXPECT_EQ(get<std::uint32_t>(file, 8), 4u);
  EXPECT_EQ(get<std::uint32_t>(file, 12), kHeaderSize);
  EXPECT_EQ(get<std::uint64_t>(file, kFileSizeAt), file.size());
  const std::size_t counts[] = {tree.blocks.size(),         tree.vertices.size(),  tree.triangles.size(),
                                tree.leaf_triangles.size(), tree.obb_nodes.size(), tree.triangle_blocks.size(),
                                tree.supports.size()};
  const std::uint32_t sizes[] = {224, 12, 12, 4, 448, 320, 4};
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t at = kTableAt + 24 * i;
    EXPECT_EQ(get<std::uint32_t>(file, at), i + 1);
    EXPECT_EQ(get<std::uint32_t>(file, at + 4), sizes[i]);
    EXPECT_EQ(get<std::uint64_t>(file, at + 8) % 64, 0u);
    EXPECT_EQ(get<std::uint64_t>(file, at + 16), counts[i]);
  }
  EXPECT_EQ(get<float>(file, kHeaderSize), tree.blocks[0].x[0]);
  EXPECT_EQ(get<float>(file, kHeaderSize + 96), tree.blocks[0].radius[0]);
  EXPECT_EQ(get<std::uint32_t>(file, 88), tree.triangle_tree_depth);
  const auto obb_nodes = get<std::uint64_t>(file, kTableAt + 24 * 4 + 8),
             triangles = get<std::uint64_t>(file, kTableAt + 24 * 5 + 8);
  EXPECT_EQ(get<float>(file, obb_nodes + 192), tree.obb_nodes[0].radius[0]);
  EXPECT_EQ(get<float>(file, triangles + 32), tree.triangle_blocks[0].corner[0][1][0]);
  EXPECT_EQ(get<std::uint32_t>(file, triangles + 288), tree.triangle_blocks[0].triangle[0]);
  const auto sealed = file;
  seal(file);
  EXPECT_EQ(file, sealed);
}

TEST(TreeFile, LoadsFromDiskAndNamesWhatFails) {
  const auto path = scratch("tree.orchard");
  const PackedSphereTree tree = sample_tree();
  const auto file = serialize(tree);
  write(path, file);
  PackedSphereTree loaded;
  EXPECT_EQ(load_file(path.string().c_str(), loaded), LoadStatus::ok);
  EXPECT_TRUE(same(loaded, tree));
  for (const std::size_t size : {std::size_t{0}, std::size_t{31}, std::size_t{100}, file.size() - 1}) {
    write(path, {file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_EQ(load_file(path.string().c_str(), loaded), LoadStatus::truncated) << size;
  }
  auto longer = file;
  longer.push_back(std::byte{0});
  write(path, longer);
  EXPECT_EQ(load_file(path.string().c_str(), loaded), LoadStatus::invalid_structure);
  auto boastful = file;  // promises more than any memory holds
  put(boastful, kFileSizeAt, ~0ull);
  write(path, boastful);
  EXPECT_EQ(load_file(path.string().c_str(), loaded), LoadStatus::truncated);
  std::filesystem::remove(path);
  EXPECT_EQ(load_file(path.string().c_str(), loaded), LoadStatus::cannot_open);
  EXPECT_EQ(load_file(std::filesystem::temp_directory_path().string().c_str(), loaded), kStatusOfFolder);
  EXPECT_TRUE(same(loaded, tree));
}

TEST(TreeFile, IsUsedInPlaceWithoutACopy) {
  const PackedSphereTree tree = build_tree(torus(16, 8, 1, 0.3));
  const auto file = serialize(tree);
  const Aligned aligned(file);
  TreeView seen;
  ASSERT_EQ(view(aligned.span(), seen), LoadStatus::ok);
  EXPECT_EQ(reinterpret_cast<const std::byte*>(seen.blocks.data()), aligned.bytes + kHeaderSize);
  EXPECT_EQ(serialize(seen), file);

  const auto path = scratch("mapped.orchard");
  write(path, file);
  MappedTree mapped;
  EXPECT_TRUE(mapped.view().blocks.empty());
  ASSERT_EQ(mapped.open(path.string().c_str()), LoadStatus::ok);
  MappedTree moved = std::move(mapped);
  EXPECT_EQ(serialize(moved.view()), file);
  test::OwnNarrowPhase by_view(moved.view(), seen), by_copy(tree, tree);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Pose pose = Draw(seed).pose(1.2);
    by_view.start({}, pose), by_copy.start({}, pose);
    while (!by_copy.finished()) by_view.refine(), by_copy.refine();
    ASSERT_EQ(by_view.answer(), by_copy.answer());
    ASSERT_EQ(by_view.progress().work, by_copy.progress().work);
    ASSERT_EQ(by_view.separation_bound(), by_copy.separation_bound());
  }
  write(path, {file.begin(), file.begin() + 100});
  EXPECT_EQ(moved.open(path.string().c_str()), LoadStatus::truncated);
  EXPECT_TRUE(moved.view().blocks.empty());
  write(path, {});
  EXPECT_EQ(moved.open(path.string().c_str()), LoadStatus::truncated);
  std::filesystem::remove(path);
  EXPECT_EQ(moved.open(path.string().c_str()), LoadStatus::cannot_open);
  EXPECT_EQ(moved.open(std::filesystem::temp_directory_path().string().c_str()), kStatusOfFolder);
}

TEST(TreeFile, IsNotUsedInPlaceWhereItIsNotAligned) {
  auto file = serialize(sample_tree());
  file.insert(file.begin(), 4, std::byte{0});
  const Aligned shifted(file);
  TreeView seen;
  EXPECT_EQ(view(shifted.span().subspan(4), seen), LoadStatus::cannot_map);
}

TEST(TreeFile, HasAMessageForEveryStatus) {
  for (int status = 0; status <= static_cast<int>(LoadStatus::cannot_map); ++status) {
    EXPECT_STRNE(message(static_cast<LoadStatus>(status)), "unknown status");
  }
}

}  // namespace
}  // namespace orchard::runtime
