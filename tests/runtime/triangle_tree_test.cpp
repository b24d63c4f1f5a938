#include <gtest/gtest.h>

#include "orchard/runtime/packed_tree.h"
#include "support.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

// Flat triangles one behind the other, in groups of eight: a group spans nine tenths of the width or of the height by
// turns, so any two groups have a larger box than any one, and nothing is cheaper than to cut off one group at the end.
Mesh stack_that_is_cheapest_to_peel(int groups) {
  constexpr double kApart = 1e-3;
  Mesh mesh;
  mesh.closed = false;
  for (int group = 0; group < groups; ++group) {
    const double x = kApart * group / groups, across = group % 2 == 0 ? 3 : 2.7, up = group % 2 == 0 ? 0.9 : 1;
    for (int i = 0; i < 8; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      mesh.vertices.insert(mesh.vertices.end(), {{x, -across, -up}, {x, across, -up}, {x, 0, 2 * up}});
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
  }
  return mesh;
}

TEST(TriangleTree, IsHalvedByNumberWhereCheapCutsWouldMakeItTooDeep) {
  constexpr int kGroups = 1000;  // cut by cost alone, they make more levels than a tree may have
  const PackedSphereTree tree = build_tree(stack_that_is_cheapest_to_peel(kGroups), {.max_depth = 1, .bounds = false});
  EXPECT_GT(tree.patch_depth, 32u);  // or this is not the input that it is meant to be
  EXPECT_LE(tree.patch_depth, kPatchDepthLimit);
  EXPECT_EQ(structure_fault(tree), nullptr);
}

}  // namespace
}  // namespace orchard::runtime
