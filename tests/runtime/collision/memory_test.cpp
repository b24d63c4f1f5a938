#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>

#include "allocation.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/tree_file.h"
#include "support.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

TEST(Memory, IsNotAllocatedByAQuery) {
  const auto tree = build_tree(torus(16, 8, 1, 0.3));
  test::OwnNarrowPhase query(tree, tree);
  Draw draw(1);
  const Pose pose = draw.pose(0.7);
  const std::size_t before = allocations;
  query.start({}, pose);
  while (!query.finished()) query.refine({.work = 100});
  query.verdict();
  query.start({}, pose);
  query.refine_exactly();
  EXPECT_EQ(query.answer(), Answer::yes);
  EXPECT_EQ(allocations, before);
}

// As where a compiler's std::vector does not respect what a type asks for.
TEST(Memory, ThatIsNotAlignedIsAFault) {
  const auto tree = build_tree(torus(16, 8, 1, 0.3));
  const auto moved = [](const auto& blocks, std::vector<std::byte>& room) {
    using Block = std::remove_cvref_t<decltype(blocks[0])>;
    room.resize((blocks.size() + 2) * sizeof(Block));
    const auto at = reinterpret_cast<std::uintptr_t>(room.data());
    std::byte* const odd = room.data() + (alignof(Block) - at % alignof(Block)) + 16;
    std::memcpy(odd, blocks.data(), blocks.size() * sizeof(Block));
    return std::span(reinterpret_cast<const Block*>(odd), blocks.size());
  };
  std::vector<std::byte> room;
  TreeView spheres(tree), slabs(tree), triangles(tree);
  EXPECT_EQ(structure_fault(spheres), nullptr);
  spheres.blocks = moved(tree.blocks, room);
  EXPECT_NE(structure_fault(spheres), nullptr);
  slabs.obb_nodes = moved(tree.obb_nodes, room);
  EXPECT_NE(structure_fault(slabs), nullptr);
  triangles.triangle_blocks = moved(tree.triangle_blocks, room);
  EXPECT_NE(structure_fault(triangles), nullptr);
}

TEST(Memory, WithoutRoomForALevelTheTrianglesDecide) {
  const auto tree = build_tree(torus(16, 8, 1, 0.3), {.leaf_triangles = 1});
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Draw draw(seed);
    const Pose pose = draw.pose(0.7 + 0.03 * static_cast<double>(seed));
    test::OwnNarrowPhase whole(tree, tree), narrow(tree, tree, 1);
    whole.start({}, pose), narrow.start({}, pose);
    while (!whole.finished()) whole.refine();
    while (!narrow.finished()) narrow.refine();
    EXPECT_FALSE(whole.progress().out_of_room);
    EXPECT_EQ(narrow.answer(), whole.answer());
    EXPECT_GE(narrow.separation_bound(), whole.separation_bound());
    EXPECT_EQ(narrow.progress().out_of_room, whole.progress().level > 2) << seed;
  }
}

TEST(Memory, WhenThereIsNoneQueriesStayValid) {
  const auto tree = build_tree(torus(16, 8, 1, 0.3));
  allocation_fails = true;
  test::OwnNarrowPhase query(tree, tree);
  allocation_fails = false;
  query.start({}, Draw(1).pose(0.7));
  for (int i = 0; i < 10 && !query.finished(); ++i) query.refine();
  query.refine_exactly();
  EXPECT_TRUE(query.finished());
  EXPECT_TRUE(query.progress().out_of_room);
  EXPECT_EQ(query.answer(), Answer::maybe);
}

// Two roots that are leaves, room for their pair, but none for the last level's stack.
TEST(Memory, WithoutAStackForTheTrianglesTwoLeavesStayUndecided) {
  const auto tree = build_tree(box({0, 0, 0}, {1, 1, 1}), {.leaf_triangles = 12});
  allocation_fails = true;
  test::OwnNarrowPhase query(tree, tree);
  test::OwnDistanceQuery distance(tree, tree);
  allocation_fails = false;
  ASSERT_TRUE(query.reserve(64));
  for (const bool exactly : {false, true}) {
    query.start({}, Pose{.translation = {0.5, 0.5, 0.5}});
    EXPECT_EQ(exactly ? query.refine_exactly() : query.refine(), Answer::maybe);
    EXPECT_TRUE(query.finished());
    EXPECT_EQ(query.start({}, Pose{.translation = {5, 0, 0}}), Answer::no);
  }
  EXPECT_EQ(collide(query, {}, Pose{.translation = {1, 0, 0}}, {.work = 10}).answer, Answer::maybe);
  distance.start({}, {});
  EXPECT_TRUE(distance.finished());
}

TEST(Memory, WhenItRunsOutIsReportedByLoading) {
  const auto file = serialize(build_tree(torus(16, 8, 1, 0.3)));
  PackedSphereTree tree;
  allocation_fails = true;
  const LoadStatus status = load(file, tree), from_disk = load_file("/dev/zero", tree);
  allocation_fails = false;
  EXPECT_EQ(status, LoadStatus::out_of_memory);
  EXPECT_NE(from_disk, LoadStatus::ok);
  EXPECT_EQ(load(file, tree), LoadStatus::ok);
}

}  // namespace
}  // namespace orchard::runtime
