#include "orchard/spheretree/proven.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/repair.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/octree.h"
#include "packed_nodes.h"
#include "support.h"
#include "support/effort.h"
#include "support/winding_oracle.h"

namespace orchard {
namespace {

using namespace test;

SphereTree measured_octree(const Surface& surface, Index depth) {
  SphereTree tree = octree(surface, {.depth = depth});
  cover(tree, surface);
  measure(tree, surface);
  return tree;
}

// The solid by brute force: what the triangles wind around, and the triangles.
class Solid {
 public:
  explicit Solid(const Surface& surface) : surface_(surface), oracle_(surface.mesh()) {}
  // Nothing where the point is all but on the surface.
  std::optional<double> signed_distance(const Point& point) const {
    double min = std::numeric_limits<double>::infinity();
    for (Index t = 0; t < surface_.mesh().triangles.size(); ++t) {
      const auto [a, b, c] = surface_.corners(t);
      min = std::min(min, closest_point_of_triangle(point, a, b, c).distance);
    }
    const auto winding = oracle_.winding(point);
    if (!winding) return std::nullopt;
    return *winding > 0 ? -min : min;
  }

 private:
  const Surface& surface_;
  WindingOracle oracle_;
};

// Every stored bound, at random points of the balls.
void expect_bounds(const Surface& surface, const runtime::PackedSphereTree& tree, int per_node, std::uint64_t seed) {
  const Solid solid(surface);
  const Point origin(tree.origin[0], tree.origin[1], tree.origin[2]);
  const double rounding = 1e-9 * surface.bounding_radius();
  Random random(seed, 41);
  for (const auto& [block_index, lane] : packed_nodes(tree)) {
    const auto& block = tree.blocks[block_index];
    const Point center = origin + Vector(block.x[lane], block.y[lane], block.z[lane]);
    // Nothing to compare where the point is all but on the surface.
    EXPECT_LE(solid.signed_distance(center).value_or(block.depth[lane]), block.depth[lane] + rounding);
    for (int i = 0; i < per_node; ++i) {
      const Vector direction = Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
      const double part = i % 2 == 0 ? 1.0 : std::cbrt(random.uniform());
      const auto distance = solid.signed_distance(center + part * block.radius[lane] * direction);
      ASSERT_LE(distance.value_or(0), block.error[lane] + rounding) << "node " << block_index << ", " << lane;
    }
  }
}

TriangleMesh crumpled(TriangleMesh mesh, double amplitude, std::uint64_t seed) {
  Random random(seed, 42);
  for (Point& p : mesh.vertices)
    p += amplitude * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  return mesh;
}

// Folds made the signed distance jump from one place to the next, and a bound over a ball hold for none of them.
TEST(PackProven, BoundsHoldForWhatTheSurfaceWindsAroundWhereItCutsItself) {
  for (std::uint64_t i = 0; i < 6 * more(); ++i) {
    const std::uint64_t seed = first_seed() + i;
    const double amplitude = 0.15 + 0.05 * static_cast<double>(seed % 3);
    const Surface surface(crumpled(seed % 2 == 0 ? icosphere(2) : torus(20, 10), amplitude, seed));
    ASSERT_TRUE(surface.solid());
    SphereTree tree = measured_octree(surface, 3);
    const ProvenTree proven = pack_proven(tree, surface);
    EXPECT_TRUE(proven.proof.ok()) << "seed " << seed;
    expect_bounds(surface, proven.packed, 12, seed);
  }
}

TEST(PackProven, ABoundThatDoesNotHoldGivesWayToOneThatDoes) {
  const Surface surface(u_shape(0.3));
  SphereTree tree = measured_octree(surface, 2);
  const auto as_measured = pack(tree, surface);
  tree.nodes[0].distance_bound = 0;
  tree.nodes[3].center_distance -= 0.2;
  tree.nodes[5].center_distance -= 1e-3;
  tree.nodes[5].distance_bound = -1;
  ASSERT_GT(tree.nodes.size(), 7u);
  const ProvenTree proven = pack_proven(tree, surface);
  for (const Violation& v : proven.proof.violations)
    ADD_FAILURE() << "not proven: kind " << static_cast<int>(v.kind) << " of node " << v.node << " by " << v.amount;
  EXPECT_TRUE(proven.proof.ok());
  EXPECT_EQ(proven.weakened, (std::vector<Index>{0, 3, 5}));
  EXPECT_TRUE(verify(surface, proven.packed).ok());
  expect_bounds(surface, proven.packed, 20, 1);
  // Not at any price: what was taken away is back.
  const auto nodes = packed_nodes(proven.packed);
  for (const Index node : {3u, 5u}) {
    const auto [block, lane] = nodes[node];
    EXPECT_NEAR(proven.packed.blocks[block].depth[lane], as_measured.blocks[block].depth[lane], 1e-5);
    EXPECT_LT(proven.packed.blocks[block].error[lane], 2 * proven.packed.blocks[block].radius[lane]);
  }
}

TEST(PackProven, LeavesBoundsThatAreProvenAlone) {
  const Surface surface(torus(24, 12));
  SphereTree tree = measured_octree(surface, 3);
  const SphereTree before = tree;
  const ProvenTree proven = pack_proven(tree, surface);
  EXPECT_TRUE(proven.proof.ok());
  EXPECT_TRUE(proven.weakened.empty());
  EXPECT_TRUE(same_tree(before, tree));
}

// 2067 pairs of its triangles cut each other.
TEST(PackProven, ProvesATreeOfAHeavilyCutRobotPart) {
  const std::filesystem::path file = std::filesystem::path(ORCHARD_SHARED_MODELS) / "robot/link_head_tilt.STL";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no shared models";
  TriangleMesh mesh = read_mesh(file);
  ASSERT_TRUE(repair_mesh(mesh).solid);
  const Surface surface(std::move(mesh));
  SphereTree tree = measured_octree(surface, 3);
  EXPECT_TRUE(pack_proven(tree, surface).proof.ok());
}

}  // namespace
}  // namespace orchard
