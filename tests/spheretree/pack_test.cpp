#include "orchard/spheretree/pack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/covering/inaccuracy.h"
#include "orchard/geometry/error.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"
#include "orchard/spheretree/certify.h"
#include "orchard/spheretree/cover.h"
#include "orchard/spheretree/measure.h"
#include "orchard/spheretree/merging.h"
#include "orchard/spheretree/octree.h"
#include "orchard/spheretree/verify.h"
#include "support.h"
#include "support/path_rule.h"
#include "support/query_of_trees.h"

namespace orchard {
namespace {

using namespace test;

SphereTree measured(const Surface& surface, Index branching, Index depth) {
  SphereTree tree =
      merge_tree(surface, axis_of(surface), {.depth = depth, .branching = branching, .closing = MergeClosing::growth})
          .tree;
  cover(tree, surface);
  measure(tree, surface);
  return tree;
}

std::vector<TriangleMesh> meshes() {
  return {torus(24, 12), l_shape(), transformed(u_shape(0.3), 1, Vector(1e5, 3e5, -2e5)),
          transformed(torus(16, 8), 1e-6, Vector::Zero())};
}

TEST(Pack, KeepsEveryBallInsideItsPackedOneAndEveryBoundBelowItsPackedOne) {
  for (const TriangleMesh& mesh : meshes()) {
    const Surface surface(mesh);
    const SphereTree tree = measured(surface, 8, 3);
    const auto packed = pack(tree, surface);
    ASSERT_EQ(runtime::structure_fault(packed), nullptr);
    const auto balls = path_balls(packed);
    ASSERT_EQ(balls.size(), tree.nodes.size());
    const Point origin(packed.origin[0], packed.origin[1], packed.origin[2]);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const SphereNode& node = tree.nodes[i];
      EXPECT_EQ(balls[i].parent, node.parent);
      EXPECT_EQ(balls[i].leaf, node.child_count == 0);
      const double moved = (node.sphere.center - origin - balls[i].center).norm();
      EXPECT_LE(moved + node.sphere.radius, balls[i].radius);
      EXPECT_NEAR(node.sphere.radius, balls[i].radius, 1e-6 * surface.bounding_radius());
    }
    for (const auto& block : packed.blocks)
      for (std::size_t lane = 0; lane < runtime::kBlockWidth; ++lane) {
        if (block.radius[lane] < 0) continue;
        const Point center = origin + Vector(block.x[lane], block.y[lane], block.z[lane]);
        const double distance = surface.signed_distance(center), slack = 1e-15 * origin.norm();
        EXPECT_GE(block.depth[lane], distance - slack);
        Point at;
        const double limit = block.error[lane] + slack + 1e-12 * surface.bounding_radius();
        EXPECT_LE(farthest_against(surface, {center, block.radius[lane]}, limit, at).lower, limit);
      }
  }
}

TEST(Pack, UnpackingGivesTheStoredFloatsInTheFrameOfTheMesh) {
  for (const TriangleMesh& mesh : meshes()) {
    const Surface surface(mesh);
    const SphereTree tree = measured(surface, 8, 3);
    const auto packed = pack(tree, surface);
    const SphereTree again = unpack(packed);
    validate(again);
    const double rounding = 1e-6 * surface.bounding_radius() + 1e-15 * surface.bounding_ball().center.norm();
    ASSERT_EQ(again.nodes.size(), tree.nodes.size());
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
      const SphereNode &was = tree.nodes[i], &is = again.nodes[i];
      EXPECT_EQ(is.parent, was.parent);
      EXPECT_EQ(is.level, was.level);
      EXPECT_EQ(is.child_count, was.child_count);
      EXPECT_EQ(is.first_child, was.first_child);
      EXPECT_LT((is.sphere.center - was.sphere.center).norm(), rounding);
      EXPECT_NEAR(is.sphere.radius, was.sphere.radius, rounding);
      EXPECT_GE(is.distance_bound, was.distance_bound);
      EXPECT_NEAR(is.distance_bound, was.distance_bound, rounding);
      EXPECT_NEAR(is.center_distance, was.center_distance, rounding);
    }
  }
}

TEST(Pack, PassesItsCertificateForAnyBranching) {
  const Surface surface(u_shape(0.3));
  for (const Index branching : {2u, 8u, 9u, 64u}) {
    const auto packed = pack(measured(surface, branching, 2), surface);
    EXPECT_EQ(runtime::structure_fault(packed), nullptr);
    EXPECT_TRUE(certify(surface, packed).complete()) << branching;
  }
}

TEST(Pack, ListsEachTriangleInEveryLeafThatTouchesIt) {
  const Surface surface(l_shape());
  const auto packed = pack(measured(surface, 8, 2), surface);
  const auto balls = path_balls(packed);
  const Point origin(packed.origin[0], packed.origin[1], packed.origin[2]);
  // Leaves in breadth-first order, with their lists.
  std::vector<std::vector<Index>> lists;
  for (const auto& block : packed.blocks)
    for (std::size_t lane = 0; lane < runtime::kBlockWidth; ++lane) {
      if (block.radius[lane] < 0) continue;
      lists.emplace_back();
      if ((block.link[lane] & runtime::kLeafBit) == 0) continue;
      for (const std::uint32_t triangle : runtime::listed_triangles(packed, block.link[lane]))
        lists.back().push_back(triangle & ~runtime::kLeafBit);
    }
  ASSERT_EQ(lists.size(), balls.size());
  for (const Point& point : points_on(surface, 40, 3)) {
    const Index triangle = surface.closest(point).triangle;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (!balls[i].leaf) continue;
      bool inside = true;
      for (Index n = static_cast<Index>(i); n != kNone; n = balls[n].parent)
        inside = inside && (point - origin - balls[n].center).norm() < balls[n].radius;
      if (!inside) continue;
      std::vector<Index> around;
      const ClosestPoint at = surface.closest(point);
      surface.triangles_at(at.triangle, at.feature, around);
      EXPECT_TRUE(std::find(lists[i].begin(), lists[i].end(), triangle) != lists[i].end());
    }
  }
}

// Nothing is promised that was not measured: a bound of 0 said that surfaces .3 apart touch.
TEST(Pack, LeavesBoundsInfiniteThatWereNotMeasured) {
  const Surface surface(torus(24, 12));
  SphereTree tree = octree(surface, {.depth = 2});
  cover(tree, surface);
  const auto packed = pack(tree, surface);
  for (const auto& block : packed.blocks)
    for (std::size_t lane = 0; lane < runtime::kBlockWidth; ++lane) {
      if (block.radius[lane] < 0) continue;
      EXPECT_EQ(block.error[lane], std::numeric_limits<float>::infinity());
      EXPECT_EQ(block.depth[lane], std::numeric_limits<float>::infinity());
    }
  EXPECT_TRUE(verify(surface, packed).ok());

  runtime::PackedSphereTree loaded;
  ASSERT_EQ(runtime::load(runtime::serialize(packed), loaded), runtime::LoadStatus::ok);
  runtime::test::OwnNarrowPhase query(loaded, loaded);
  runtime::Pose beside;
  beside.rotation = {1, 0, 0, 0, 0, -1, 0, 1, 0};  // links of a chain, .3 between the two
  beside.translation = {1, 0, 0};
  query.start({}, beside);
  int open = 0;
  for (; query.answer() == runtime::Answer::maybe && !query.finished(); query.refine(), ++open)
    EXPECT_EQ(query.separation_bound(), std::numeric_limits<double>::infinity());
  EXPECT_GT(open, 0);
  EXPECT_EQ(query.answer(), runtime::Answer::no);

  measure(tree, surface);
  const auto measured = pack(tree, surface);
  runtime::test::OwnNarrowPhase known(measured, measured);
  for (known.start({}, beside); !known.finished(); known.refine()) EXPECT_GE(known.separation_bound(), 0.3);
  EXPECT_LT(known.separation_bound(), 10);
}

TEST(Pack, RefusesABallThatNoReaderWouldTake) {
  const Surface surface(torus(24, 12));
  SphereTree tree = octree(surface, {.depth = 1});
  tree.nodes[1].sphere.radius = 1e20;
  EXPECT_THROW(pack(tree, surface), Error);
}

// The largest and the smallest meshes that are read make trees that load.
TEST(Pack, MakesTreesThatLoadOfEveryMeshThatIsRead) {
  TriangleMesh shape = torus(16, 8);
  double max = 0;
  for (const Point& p : shape.vertices) max = std::max(max, p.cwiseAbs().maxCoeff());
  for (const double scale : {kMaxCoordinate / max, 0.51 * kMinExtent / max, 1.0}) {
    TriangleMesh mesh = transformed(shape, scale, Vector::Zero());
    for (Point& p : mesh.vertices) p = p.cwiseMin(kMaxCoordinate).cwiseMax(-kMaxCoordinate);
    ASSERT_NO_THROW(require_usable_size(mesh));
    const Surface surface(mesh);
    const auto packed = pack(measured(surface, 8, 2), surface);
    runtime::PackedSphereTree loaded;
    ASSERT_EQ(runtime::load(runtime::serialize(packed), loaded), runtime::LoadStatus::ok) << scale;
    EXPECT_TRUE(verify(surface, loaded).ok()) << scale;
  }
}

// A damaged tree may still be conservative, where other paths cover: sampling decides what must be rejected.
TEST(Certify, RejectsEveryDamagedTreeThatLeavesASampleWithoutAPath) {
  const Surface surface(torus(24, 12));
  const auto good = pack(measured(surface, 8, 2), surface);
  ASSERT_TRUE(certify(surface, good).complete());
  const Point origin(good.origin[0], good.origin[1], good.origin[2]);
  const auto samples = points_on(surface, 60, 5);
  int must_reject = 0;
  for (std::size_t block = 1; block < good.blocks.size(); ++block)
    for (std::size_t lane = 0; lane < 8; lane += 3) {
      auto damaged = good;
      if (lane % 2 == 0) {
        damaged.blocks[block].radius[lane] *= 0.8f;
      } else {
        damaged.blocks[block].x[lane] += 0.3f;
      }
      const auto balls = path_balls(damaged);
      const bool hole = std::any_of(samples.begin(), samples.end(),
                                    [&](const Point& p) { return !in_some_path_region(p - origin, balls); });
      must_reject += hole;
      if (hole) {
        EXPECT_FALSE(certify(surface, damaged).complete()) << block << ", " << lane;
      }
    }
  EXPECT_GT(must_reject, 5);
}

TEST(Pack, RefusesATreeWithoutARoot) {
  const Surface surface(torus(24, 12));
  EXPECT_THROW(pack(SphereTree{}, surface), Error);
}

}  // namespace
}  // namespace orchard
