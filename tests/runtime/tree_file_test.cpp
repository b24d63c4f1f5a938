#include "orchard/runtime/tree_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>

#include "orchard/runtime/mapped_tree.h"
#include "orchard/runtime/narrow_phase.h"
#include "support.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

constexpr std::size_t kChecksumAt = 16, kFileSizeAt = 24, kTableAt = 96, kHeaderSize = 320;

template <typename T>
T get(const std::vector<std::byte>& file, std::size_t at) {
  T value;
  std::memcpy(&value, file.data() + at, sizeof value);
  return value;
}

template <typename T>
void put(std::vector<std::byte>& file, std::size_t at, T value) {
  std::memcpy(file.data() + at, &value, sizeof value);
}

// Written from docs/FORMATS.md, not from the implementation.
void seal(std::vector<std::byte>& file) {
  std::uint64_t h = 0x6f72636861726421;
  for (std::size_t at = 0; at + 8 <= file.size(); at += 8) {
    if (at == kChecksumAt) continue;
    h ^= get<std::uint64_t>(file, at);
    h *= 0x9e3779b97f4a7c15;
    h ^= h >> 32;
  }
  put(file, kChecksumAt, h);
}

bool same(const PackedSphereTree& a, const PackedSphereTree& b) { return serialize(a) == serialize(b); }

PackedSphereTree sample_tree() {
  return build_tree(l_shape(), {.branching = 3, .leaf_triangles = 2, .origin = {1e6, -0.125, 3}});
}

struct Aligned {  // a copy of some bytes where view() wants them, and not a byte more
  explicit Aligned(std::span<const std::byte> from)
      : bytes(static_cast<std::byte*>(::operator new (from.size(), std::align_val_t{kViewAlignment}))),
        size(from.size()) {
    if (size > 0) std::memcpy(bytes, from.data(), size);
  }
  ~Aligned() { ::operator delete (bytes, std::align_val_t{kViewAlignment}); }
  Aligned(const Aligned&) = delete;
  std::span<const std::byte> span() const { return {bytes, size}; }
  std::byte* bytes;
  std::size_t size;
};

// `out` must survive every failed load, and a view must agree.
LoadStatus load_or_keep(std::span<const std::byte> file) {
  TreeView seen;
  const Aligned aligned(file);
  const LoadStatus view_status = view(aligned.span(), seen);
  EXPECT_TRUE(view_status == LoadStatus::ok ? structure_fault(seen) == nullptr : seen.blocks.empty());
  const PackedSphereTree before = build_tree(box({0, 0, 0}, {1, 1, 1}));
  PackedSphereTree out = before;
  const LoadStatus status = load(file, out);
  EXPECT_EQ(status, view_status);
  EXPECT_EQ(structure_fault(out), nullptr);
  EXPECT_TRUE(status == LoadStatus::ok || same(before, out));
  if (status == LoadStatus::ok) {  // one tree, one form
    EXPECT_TRUE(std::ranges::equal(serialize(out), file));
    EXPECT_TRUE(std::ranges::equal(serialize(seen), file));
  }
  return status;
}

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
  EXPECT_EQ(get<std::uint32_t>(file, 8), 3u);
  EXPECT_EQ(get<std::uint32_t>(file, 12), kHeaderSize);
  EXPECT_EQ(get<std::uint64_t>(file, kFileSizeAt), file.size());
  const std::size_t counts[] = {tree.blocks.size(),         tree.vertices.size(), tree.triangles.size(),
                                tree.leaf_triangles.size(), tree.patches.size(),  tree.triangle_blocks.size(),
                                tree.supports.size()};
  const std::uint32_t sizes[] = {224, 12, 12, 4, 288, 320, 4};
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t at = kTableAt + 24 * i;
    EXPECT_EQ(get<std::uint32_t>(file, at), i + 1);
    EXPECT_EQ(get<std::uint32_t>(file, at + 4), sizes[i]);
    EXPECT_EQ(get<std::uint64_t>(file, at + 8) % 64, 0u);
    EXPECT_EQ(get<std::uint64_t>(file, at + 16), counts[i]);
  }
  EXPECT_EQ(get<float>(file, kHeaderSize), tree.blocks[0].x[0]);
  EXPECT_EQ(get<float>(file, kHeaderSize + 96), tree.blocks[0].radius[0]);
  EXPECT_EQ(get<std::uint32_t>(file, 88), tree.patch_depth);
  const auto patches = get<std::uint64_t>(file, kTableAt + 24 * 4 + 8),
             triangles = get<std::uint64_t>(file, kTableAt + 24 * 5 + 8);
  EXPECT_EQ(get<float>(file, patches + 192), tree.patches[0].radius[0]);
  EXPECT_EQ(get<float>(file, triangles + 32), tree.triangle_blocks[0].corner[0][1][0]);
  EXPECT_EQ(get<std::uint32_t>(file, triangles + 288), tree.triangle_blocks[0].triangle[0]);
  const auto sealed = file;
  seal(file);
  EXPECT_EQ(file, sealed);
}

TEST(TreeFile, ReportsEveryTruncation) {
  const auto file = serialize(sample_tree());
  for (std::size_t size = 0; size < file.size(); ++size) {
    ASSERT_EQ(load_or_keep(std::span(file).first(size)), LoadStatus::truncated) << size << " bytes";
  }
}

TEST(TreeFile, ReportsEveryAlteredByte) {
  const auto file = serialize(build_tree(box({0, 0, 0}, {1, 1, 1}), {.leaf_triangles = 100}));
  for (std::size_t at = 0; at < file.size(); ++at) {
    for (const int flip : {1, 0x80, 0xff}) {
      auto altered = file;
      altered[at] ^= std::byte(flip);
      const LoadStatus status = load_or_keep(altered);
      ASSERT_NE(status, LoadStatus::ok) << "byte " << at;
      const bool expected = at < 8    ? status == LoadStatus::bad_magic
                            : at < 32 ? status != LoadStatus::bad_magic
                                      : status == LoadStatus::checksum_mismatch;
      ASSERT_TRUE(expected) << "byte " << at << ": " << message(status);
    }
  }
}

TEST(TreeFile, RefusesOtherVersionsAndTrailingBytes) {
  auto newer = serialize(sample_tree());
  put(newer, 8, std::uint32_t{4});
  seal(newer);
  EXPECT_EQ(load_or_keep(newer), LoadStatus::version_newer);
  auto older = serialize(sample_tree());
  put(older, 8, std::uint32_t{1});
  seal(older);
  EXPECT_EQ(load_or_keep(older), LoadStatus::version_older);
  auto longer = serialize(sample_tree());
  longer.resize(longer.size() + 64);
  EXPECT_EQ(load_or_keep(longer), LoadStatus::invalid_structure);
}

TEST(TreeFile, RefusesSealedFilesWithImpossibleTables) {
  const auto file = serialize(sample_tree());
  const std::uint64_t values[] = {0, 1, file.size(), file.size() / 12, 1ull << 32, 1ull << 60, ~0ull, ~0ull / 12};
  for (std::size_t section = 0; section < 7; ++section) {
    for (const std::size_t field : {0u, 4u, 8u, 16u}) {
      for (const std::uint64_t value : values) {
        const std::size_t at = kTableAt + 24 * section + field;
        auto altered = file;
        if (field < 8) {
          put(altered, at, static_cast<std::uint32_t>(value));
        } else {
          put(altered, at, value);
        }
        if (altered == file) continue;
        seal(altered);
        ASSERT_EQ(load_or_keep(altered), LoadStatus::invalid_structure) << section << " " << field << " " << value;
      }
    }
  }
}

TEST(TreeFile, RefusesSealedFilesWhoseTreesAreNotSafeToWalk) {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  using Change = std::function<void(PackedSphereTree&)>;
  const std::vector<std::pair<const char*, Change>> cases = {
      {"no blocks", [](auto& t) { t.blocks.clear(); }},
      {"root lane empty", [](auto& t) { t.blocks[0].radius[0] = -1; }},
      {"second root", [](auto& t) { t.blocks[0].radius[1] = 1; }},
      {"child before parent",
       [](auto& t) {
         t.blocks[1].link[0] = inner_link(t.branching, {0, 1});
       }},
      {"shared block", [](auto& t) { t.blocks[1].link[1] = t.blocks[1].link[0]; }},
      {"child beyond the end", [](auto& t) { t.blocks[0].link[0] |= 1u << 30; }},
      {"too many children", [](auto& t) { t.blocks[0].link[0] += 1; }},
      {"huge child count", [](auto& t) { t.branching = 0x7fffffff, t.blocks[0].link[0] = 0x7fffffff; }},
      {"no branching", [](auto& t) { t.branching = 0; }},
      {"fewer children than lanes", [](auto& t) { t.blocks[0].link[0] -= 1; }},
      {"orphan block", [](auto& t) { t.blocks.push_back(t.blocks.back()); }},
      {"wrong depth", [](auto& t) { t.depth += 1; }},
      {"depth wraps", [](auto& t) { t.depth = ~0u; }},
      {"wrong node count", [](auto& t) { t.node_count += 1; }},
      {"centre not a number", [=](auto& t) { t.blocks[1].y[1] = nan; }},
      {"centre infinite", [=](auto& t) { t.blocks[1].z[1] = -infinity; }},
      {"centre out of range", [](auto& t) { t.blocks[1].x[1] = 2e18f; }},
      {"radius not a number", [=](auto& t) { t.blocks[1].radius[1] = nan; }},
      {"radius infinite", [=](auto& t) { t.blocks[1].radius[1] = infinity; }},
      {"radius below zero", [](auto& t) { t.blocks[1].radius[0] = -1e-30f; }},
      {"error below zero", [](auto& t) { t.blocks[1].error[0] = -1e-30f; }},
      {"error not a number", [=](auto& t) { t.blocks[1].error[0] = nan; }},
      {"depth not a number", [=](auto& t) { t.blocks[1].depth[0] = nan; }},
      {"empty lane not marked", [=](auto& t) { t.blocks[1].radius[7] = nan; }},
      {"origin not a number", [](auto& t) { t.origin[2] = std::numeric_limits<double>::quiet_NaN(); }},
      {"origin out of range", [](auto& t) { t.origin[1] = -1.001e18; }},
      {"bounding radius out of range", [](auto& t) { t.bounding_radius = 5e18; }},
      {"vertex error out of range", [](auto& t) { t.vertex_error = 5e18; }},
      {"bounding radius infinite", [](auto& t) { t.bounding_radius = std::numeric_limits<double>::infinity(); }},
      {"vertex error below zero", [](auto& t) { t.vertex_error = -1; }},
      {"vertex not a number", [=](auto& t) { t.vertices[1][2] = nan; }},
      {"triangle beyond the vertices",
       [](auto& t) { t.triangles[1][2] = static_cast<std::uint32_t>(t.vertices.size()); }},
      {"leaf triangle beyond the end",
       [](auto& t) { t.leaf_triangles[2] = static_cast<std::uint32_t>(t.triangles.size()); }},
      {"no tree of triangles", [](auto& t) { t.patches.clear(), t.triangle_blocks.clear(); }},
      {"patch not a number", [=](auto& t) { t.patches[1].height[1] = nan; }},
      {"patch with a negative radius", [](auto& t) { t.patches[1].radius[0] = -2; }},
      {"second root patch", [](auto& t) { t.patches[0].radius[1] = 1; }},
      {"patch behind an empty lane", [](auto& t) { t.patches[1].radius[0] = -1; }},
      {"normal too long", [](auto& t) { t.patches[1].nx[0] += 0.01f; }},
      {"patch its own child", [](auto& t) { t.patches[0].child[0] = 0; }},
      {"patch child beyond the end", [](auto& t) { t.patches[1].child[0] = 1u << 20; }},
      {"triangle block beyond the end", [](auto& t) { t.patches[1].child[0] = kLeafBit | (1u << 20); }},
      {"shared triangle block", [](auto& t) { t.patches[1].child[1] = t.patches[1].child[0]; }},
      {"orphan triangle block", [](auto& t) { t.triangle_blocks.push_back(t.triangle_blocks.back()); }},
      {"wrong patch depth", [](auto& t) { t.patch_depth += 1; }},
      {"block names no triangle", [](auto& t) { t.triangle_blocks[0].triangle[0] = kNoTriangle; }},
      {"block names a triangle beyond the end", [](auto& t) { t.triangle_blocks[0].triangle[1] = 1u << 20; }},
      {"block leaves a triangle out", [](auto& t) { t.triangle_blocks[0].triangle[1] = kNoTriangle; }},
      {"block moves a corner", [](auto& t) { t.triangle_blocks[0].corner[2][1][1] += 1; }},
      {"no supports", [](auto& t) { t.supports.clear(); }},
      {"too many supports", [](auto& t) { t.supports.push_back(0); }},
      {"support not a number", [=](auto& t) { t.supports[100] = nan; }},
      {"leaf list without an end", [](auto& t) { t.leaf_triangles.back() &= ~kLeafBit; }},
      {"leaf list beyond the end",
       [](auto& t) { t.blocks.back().link[0] = kLeafBit | static_cast<std::uint32_t>(t.leaf_triangles.size()); }},
  };
  ASSERT_EQ(structure_fault(sample_tree()), nullptr);
  for (const auto& [name, change] : cases) {
    SCOPED_TRACE(name);
    PackedSphereTree tree = sample_tree();
    change(tree);
    EXPECT_NE(structure_fault(tree), nullptr);
    EXPECT_EQ(load_or_keep(serialize(tree)), LoadStatus::invalid_structure);
  }
}

TEST(TreeFile, AcceptsUnknownBoundsAndNothingElseAfterRandomDamage) {
  PackedSphereTree unknown = sample_tree();
  unknown.blocks[1].error[0] = unknown.blocks[1].depth[0] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(load_or_keep(serialize(unknown)), LoadStatus::ok);
  const auto file = serialize(sample_tree());
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    Draw draw(seed);
    auto damaged = file;
    for (std::uint64_t changes = draw.bits() % 3;; --changes) {
      damaged[draw.bits() % damaged.size()] = std::byte(draw.bits());
      if (changes == 0) break;
    }
    seal(damaged);
    load_or_keep(damaged);  // checks that whatever loads has no structure fault
  }
}

TEST(TreeFile, RefusesWhateverIsNotZeroWhereNothingBelongs) {
  const auto file = serialize(sample_tree());
  std::vector<bool> meant(file.size());
  const auto mark = [&meant](std::size_t begin, std::size_t size) {
    std::fill_n(meant.begin() + std::ptrdiff_t(begin), size, true);
  };
  mark(0, 92), mark(96, 7 * 24);
  const std::size_t sizes[] = {224, 12, 12, 4, 288, 320, 4};
  for (std::size_t i = 0; i < 7; ++i) {
    const std::size_t at = kTableAt + 24 * i;
    mark(get<std::uint64_t>(file, at + 8), get<std::uint64_t>(file, at + 16) * sizes[i]);
  }
  int reserved = 0;
  for (std::size_t at = 0; at < file.size(); ++at) {
    if (meant[at]) continue;
    ++reserved;
    for (const int value : {1, 0x80, 0xff}) {
      auto altered = file;
      altered[at] = std::byte(value);
      seal(altered);
      ASSERT_EQ(load_or_keep(altered), LoadStatus::invalid_structure) << at;
    }
  }
  EXPECT_GT(reserved, 4 + 56);
}

TEST(TreeFile, IsTruncatedWhereThereIsNothingAtAll) {
  PackedSphereTree tree;
  TreeView seen;
  EXPECT_EQ(load({}, tree), LoadStatus::truncated);
  EXPECT_EQ(view({}, seen), LoadStatus::truncated);
}

// Every byte in turn, so that whatever loads is known to have been written so.
TEST(TreeFile, GivesBackTheBytesOfEveryMutantThatLoads) {
  const auto file = serialize(build_tree(box({0, 0, 0}, {1, 1, 1}), {.leaf_triangles = 100, .bounds = false}));
  int loaded = 0;
  for (std::size_t at = 32; at < file.size(); ++at) {
    auto altered = file;
    altered[at] ^= std::byte(at % 8 < 4 ? 1 : 0x80);
    seal(altered);
    loaded += load_or_keep(altered) == LoadStatus::ok;
  }
  EXPECT_GT(loaded, 300);
}

TEST(TreeFile, LoadsFromDiskAndNamesWhatFails) {
  const auto path = scratch("tree.orchard");
  const PackedSphereTree tree = sample_tree();
  const auto file = serialize(tree);
  write(path, file);
  PackedSphereTree loaded;
  EXPECT_EQ(load_file(path.c_str(), loaded), LoadStatus::ok);
  EXPECT_TRUE(same(loaded, tree));
  for (const std::size_t size : {std::size_t{0}, std::size_t{31}, std::size_t{100}, file.size() - 1}) {
    write(path, {file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_EQ(load_file(path.c_str(), loaded), LoadStatus::truncated) << size;
  }
  auto longer = file;
  longer.push_back(std::byte{0});
  write(path, longer);
  EXPECT_EQ(load_file(path.c_str(), loaded), LoadStatus::invalid_structure);
  auto boastful = file;  // promises more than any memory holds
  put(boastful, kFileSizeAt, ~0ull);
  write(path, boastful);
  EXPECT_EQ(load_file(path.c_str(), loaded), LoadStatus::truncated);
  std::filesystem::remove(path);
  EXPECT_EQ(load_file(path.c_str(), loaded), LoadStatus::cannot_open);
  EXPECT_EQ(load_file(std::filesystem::temp_directory_path().c_str(), loaded), LoadStatus::read_failed);
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
  ASSERT_EQ(mapped.open(path.c_str()), LoadStatus::ok);
  MappedTree moved = std::move(mapped);
  EXPECT_EQ(serialize(moved.view()), file);
  NarrowPhase by_view(moved.view(), seen), by_copy(tree, tree);
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const Pose pose = Draw(seed).pose(1.2);
    by_view.start({}, pose), by_copy.start({}, pose);
    while (!by_copy.finished()) by_view.refine(), by_copy.refine();
    ASSERT_EQ(by_view.answer(), by_copy.answer());
    ASSERT_EQ(by_view.work(), by_copy.work());
    ASSERT_EQ(by_view.separation_bound(), by_copy.separation_bound());
  }
  write(path, {file.begin(), file.begin() + 100});
  EXPECT_EQ(moved.open(path.c_str()), LoadStatus::truncated);
  EXPECT_TRUE(moved.view().blocks.empty());
  write(path, {});
  EXPECT_EQ(moved.open(path.c_str()), LoadStatus::truncated);
  std::filesystem::remove(path);
  EXPECT_EQ(moved.open(path.c_str()), LoadStatus::cannot_open);
  EXPECT_EQ(moved.open(std::filesystem::temp_directory_path().c_str()), LoadStatus::read_failed);
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
