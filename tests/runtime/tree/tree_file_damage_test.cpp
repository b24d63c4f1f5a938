// What a reader must refuse: cut off files, altered bytes, and files that are sealed as if they were good.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "tree_file_support.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

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
  put(newer, 8, std::uint32_t{5});
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

using Change = std::function<void(PackedSphereTree&)>;

using Changes = std::vector<std::pair<const char*, Change>>;

// Each makes the sample tree unsafe to walk: its spheres and vertices.
Changes unsafe_sphere_changes() {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  return {
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
  };
}

// Each makes the sample tree unsafe to walk: the tree of its triangles and the leaves' lists.
Changes unsafe_triangle_changes() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return {
      {"no tree of triangles", [](auto& t) { t.obb_nodes.clear(), t.triangle_blocks.clear(); }},
      {"slab not a number", [=](auto& t) { t.obb_nodes[1].height[1] = nan; }},
      {"slab with a negative radius", [](auto& t) { t.obb_nodes[1].radius[0] = -2; }},
      {"second root slab", [](auto& t) { t.obb_nodes[0].radius[1] = 1; }},
      {"slab behind an empty lane", [](auto& t) { t.obb_nodes[1].radius[0] = -1; }},
      {"normal too long", [](auto& t) { t.obb_nodes[1].nx[0] += 0.01f; }},
      {"second normal too long", [](auto& t) { t.obb_nodes[1].mx[0] += 1.01f; }},
      {"normals not at right angles",
       [](auto& t) {
         auto& block = t.obb_nodes[1];
         block.mx[0] = block.nx[0], block.my[0] = block.ny[0], block.mz[0] = block.nz[0];
       }},
      {"slab with a negative width", [](auto& t) { t.obb_nodes[1].width[0] = -1; }},
      {"slab with an infinite length",
       [](auto& t) { t.obb_nodes[1].length[0] = std::numeric_limits<float>::infinity(); }},
      {"slab its own child", [](auto& t) { t.obb_nodes[0].child[0] = 0; }},
      {"slab child beyond the end", [](auto& t) { t.obb_nodes[1].child[0] = 1u << 20; }},
      {"triangle block beyond the end", [](auto& t) { t.obb_nodes[1].child[0] = kLeafBit | (1u << 20); }},
      {"shared triangle block", [](auto& t) { t.obb_nodes[1].child[1] = t.obb_nodes[1].child[0]; }},
      {"orphan triangle block", [](auto& t) { t.triangle_blocks.push_back(t.triangle_blocks.back()); }},
      {"wrong slab depth", [](auto& t) { t.triangle_tree_depth += 1; }},
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
}

TEST(TreeFile, RefusesSealedFilesWhoseTreesAreNotSafeToWalk) {
  ASSERT_EQ(structure_fault(sample_tree()), nullptr);
  Changes changes = unsafe_sphere_changes();
  for (auto& change : unsafe_triangle_changes()) changes.push_back(std::move(change));
  for (const auto& [name, change] : changes) {
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
  const std::size_t sizes[] = {224, 12, 12, 4, 448, 320, 4};
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

}  // namespace
}  // namespace orchard::runtime
