#include <gtest/gtest.h>

#include "allocation.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"
#include "support.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

TEST(Memory, IsNotAllocatedByAQueryAfterTheFirst) {
  const auto tree = build_tree(torus(16, 8, 1, 0.3));
  NarrowPhase query(tree, tree);
  Draw draw(1);
  const Pose pose = draw.pose(0.7);
  for (int round = 0; round < 2; ++round) {
    const std::size_t before = allocations;
    query.start({}, pose);
    while (!query.finished()) query.refine({.pair_tests = 100});
    query.contact();
    EXPECT_EQ(allocations > before, round == 0);
  }
  NarrowPhase prepared(tree, tree);
  ASSERT_TRUE(prepared.reserve(10000));
  const std::size_t before = allocations;
  prepared.start({}, pose);
  while (!prepared.finished()) prepared.refine();
  EXPECT_EQ(allocations, before);
}

TEST(Memory, WhenItRunsOutLeavesTheAnswerAndTheQueryGoesOnLater) {
  const auto tree = build_tree(torus(16, 8, 1, 0.3), {.leaf_triangles = 1});
  Draw draw(1);
  const Pose pose = draw.pose(0.7);
  NarrowPhase whole(tree, tree), starved(tree, tree);
  whole.start({}, pose);
  while (!whole.finished()) whole.refine();
  starved.start({}, pose);
  int failures = 0;
  while (!starved.finished()) {
    allocation_fails = true;
    const Answer answer = starved.refine();
    allocation_fails = false;
    if (!starved.out_of_memory()) continue;
    ++failures;
    EXPECT_EQ(answer, Answer::maybe);
    const double bound = starved.separation_bound();
    starved.refine({.pair_tests = 1});  // enough to get the memory
    EXPECT_FALSE(starved.out_of_memory());
    EXPECT_LE(starved.separation_bound(), bound);
  }
  EXPECT_GT(failures, 2);
  EXPECT_EQ(starved.answer(), whole.answer());
  EXPECT_EQ(starved.pair_tests(), whole.pair_tests());
  EXPECT_EQ(starved.separation_bound(), whole.separation_bound());
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
