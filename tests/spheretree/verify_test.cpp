#include "orchard/spheretree/verify.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>

#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/pack.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;
using runtime::PackedSphereTree;

PackedSphereTree packed_tree(const Surface& surface) {
  SphereTree tree = merge_tree(surface, axis_of(surface), {.depth = 2});
  cover(tree, surface);
  measure(tree, surface);
  return pack(tree, surface);
}

TEST(Verify, AcceptsWhatIsBuiltAtAnyScaleAndOffset) {
  for (const TriangleMesh& mesh : {torus(24, 12), l_shape(), transformed(u_shape(0.3), 1, Vector(1e6, 3e6, -2e6)),
                                   transformed(torus(16, 8), 1e-6, Vector::Zero())}) {
    const Surface surface(mesh);
    const Verification result = verify(surface, packed_tree(surface));
    EXPECT_TRUE(result.ok());
    EXPECT_TRUE(result.violations.empty());
    EXPECT_EQ(result.triangles, mesh.triangles.size());
    SphereTree tree = octree(surface);
    measure(tree, surface);
    EXPECT_TRUE(verify(surface, pack(tree, surface)).ok());
  }
}

TEST(Verify, AcceptsTheOctreeOfAnOpenSurface) {
  const Surface surface(open_box());
  SphereTree tree = octree(surface);
  measure(tree, surface);
  EXPECT_TRUE(verify(surface, pack(tree, surface)).ok());
}

TEST(Verify, RejectsEachKindOfDamage) {
  const Surface surface(l_shape());
  const PackedSphereTree good = packed_tree(surface);
  ASSERT_TRUE(verify(surface, good).ok());
  const auto radius = static_cast<float>(good.bounding_radius);
  struct Damage {
    const char* name;
    std::function<void(PackedSphereTree&)> apply;
  };
  const std::vector<Damage> damages{
      {"all leaves moved",
       [&](PackedSphereTree& t) {
         for (std::size_t b = 2; b < t.blocks.size(); ++b)
           for (float& x : t.blocks[b].x) x += 0.05f * radius;
       }},
      {"radii shrunk",
       [&](PackedSphereTree& t) {
         for (std::size_t b = 1; b < t.blocks.size(); ++b)
           for (float& r : t.blocks[b].radius) r *= r > 0 ? 0.9f : 1.0f;
       }},
      {"a distance lowered", [&](PackedSphereTree& t) { t.blocks[1].depth[0] -= 1e-4f * radius; }},
      {"a bound lowered", [&](PackedSphereTree& t) { t.blocks[0].error[0] *= 0.5f; }},
      {"a leaf's triangles dropped",
       [&](PackedSphereTree& t) {
         for (auto& count : t.blocks.back().count)
           if (count & runtime::kLeafBit) count = runtime::kLeafBit;
       }},
      {"children swapped",
       [&](PackedSphereTree& t) {
         std::swap(t.blocks[0 + 1].first[0], t.blocks[1].first[1]);
         std::swap(t.blocks[0 + 1].count[0], t.blocks[1].count[1]);
       }},
      {"a vertex moved", [&](PackedSphereTree& t) { t.vertices[0][0] += 1e-3f * radius; }},
      {"a triangle exchanged", [&](PackedSphereTree& t) { std::swap(t.triangles[0][0], t.triangles[0][1]); }},
      {"a triangle lost", [&](PackedSphereTree& t) { t.triangles.pop_back(); }},
  };
  for (const Damage& damage : damages) {
    PackedSphereTree tree = good;
    damage.apply(tree);
    const Verification result = verify(surface, tree);
    EXPECT_FALSE(result.ok()) << damage.name;
    EXPECT_FALSE(result.violations.empty()) << damage.name;
  }
}

TEST(Verify, NamesAPointThatHasNoPathAndHowDeepItLies) {
  const Surface surface(torus(24, 12));
  PackedSphereTree tree = packed_tree(surface);
  for (std::size_t b = 1; b < tree.blocks.size(); ++b)
    for (float& r : tree.blocks[b].radius) r *= r > 0 ? 0.9f : 1.0f;
  const Verification result = verify(surface, tree);
  ASSERT_FALSE(result.ok());
  EXPECT_GT(result.worst_depth, 0);
  for (const Violation& violation : result.violations) {
    ASSERT_EQ(violation.kind, Violation::Kind::uncovered);
    EXPECT_LT(surface.distance(violation.point), 1e-9);
  }
}

TEST(Verify, ListsNoMoreViolationsThanAskedForButCountsAll) {
  const Surface surface(torus(24, 12));
  PackedSphereTree tree = packed_tree(surface);
  for (std::size_t b = 1; b < tree.blocks.size(); ++b)
    for (float& r : tree.blocks[b].radius) r *= r > 0 ? 0.5f : 1.0f;
  const Verification result = verify(surface, tree, {.most_violations = 3});
  EXPECT_EQ(result.violations.size(), 3u);
  EXPECT_GT(result.triangles_uncovered, 3u);
}

TEST(Verify, IsTheSameOnOneTwoAndSevenThreads) {
  const Surface surface(torus(24, 12));
  PackedSphereTree tree = packed_tree(surface);
  for (auto& block : tree.blocks) block.radius[1] *= 0.7f;
  std::vector<Verification> results;
  for (const std::size_t threads : {1u, 2u, 7u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(verify(surface, tree));
  }
  for (const Verification& other : results) {
    ASSERT_EQ(other.violations.size(), results[0].violations.size());
    EXPECT_EQ(other.worst_depth, results[0].worst_depth);
    for (std::size_t i = 0; i < other.violations.size(); ++i) {
      EXPECT_EQ(other.violations[i].triangle, results[0].violations[i].triangle);
      EXPECT_EQ(other.violations[i].point, results[0].violations[i].point);
    }
  }
}

}  // namespace
}  // namespace orchard
