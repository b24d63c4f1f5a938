#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/kernels/node_box.h"  // private
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
  EXPECT_GT(tree.triangle_tree_depth, 32u);  // or this is not the input that it is meant to be
  EXPECT_LE(tree.triangle_tree_depth, kTriangleTreeDepthLimit);
  EXPECT_EQ(structure_fault(tree), nullptr);
}

void add_triangles_below(const PackedSphereTree& tree, std::uint32_t child, std::vector<std::uint32_t>& triangles) {
  if (child & kLeafBit) {
    for (const std::uint32_t t : tree.triangle_blocks[child & ~kLeafBit].triangle) {
      if (t != kNoTriangle) triangles.push_back(t);
    }
    return;
  }
  const ObbNodeBlock& block = tree.obb_nodes[child];
  for (std::size_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
    add_triangles_below(tree, block.child[lane], triangles);
  }
}

// Without any tolerance: rays and capsules allow ball slabs no more than the rounding of doubles.
TEST(TriangleTree, HoldsEveryTriangleInEveryObbNodeAboveItAsStored) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const PackedSphereTree tree = build_tree(seed % 2 == 0 ? spikes(seed, 12, 9) : soup(seed, 80), {.bounds = false});
    for (std::size_t b = 0; b < tree.obb_nodes.size(); ++b) {
      const ObbNodeBlock& p = tree.obb_nodes[b];
      for (std::size_t lane = 0; lane < kBlockWidth && p.radius[lane] >= 0; ++lane) {
        std::vector<std::uint32_t> triangles;
        add_triangles_below(tree, p.child[lane], triangles);
        for (const std::uint32_t t : triangles) {
          for (const std::uint32_t v : tree.triangles[t]) {
            using Real = long double;
            const Real x = Real{tree.vertices[v][0]} - p.x[lane], y = Real{tree.vertices[v][1]} - p.y[lane],
                       z = Real{tree.vertices[v][2]} - p.z[lane];
            ASSERT_LE(std::sqrt(x * x + y * y + z * z), p.radius[lane]) << seed << " block " << b;
            ASSERT_LE(std::fabs(p.nx[lane] * x + p.ny[lane] * y + p.nz[lane] * z), p.height[lane])
                << seed << " block " << b;
            ASSERT_LE(std::fabs(p.mx[lane] * x + p.my[lane] * y + p.mz[lane] * z), p.width[lane])
                << seed << " block " << b;
            const auto l = detail::third_normal(detail::node_box_at(p, static_cast<std::uint32_t>(lane)));
            ASSERT_LE(std::fabs(l[0] * x + l[1] * y + l[2] * z), p.length[lane]) << seed << " block " << b;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
