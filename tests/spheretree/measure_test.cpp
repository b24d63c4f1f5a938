#include "orchard/spheretree/measure.h"

#include <gtest/gtest.h>

#include <cmath>

#include "orchard/covering/inaccuracy.h"
#include "orchard/spheretree/octree.h"
#include "support.h"

namespace orchard {
namespace {

using namespace test;

TEST(Measure, BoundsTheDistanceOfEveryPointOfTheBall) {
  const Surface surface(u_shape(0.3));
  SphereTree tree = octree(surface);
  measure(tree, surface);
  Random random(1, 1);
  for (const SphereNode& node : tree.nodes) {
    EXPECT_NEAR(node.center_distance, surface.signed_distance(node.sphere.center), 1e-12);
    EXPECT_LE(node.inaccuracy, node.distance_bound + 1e-12);
    for (int i = 0; i < 20; ++i) {
      Vector direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const Point point = node.sphere.center + node.sphere.radius * direction.normalized();
      const double distance = std::max(0.0, surface.signed_distance(point));
      EXPECT_LE(distance, node.distance_bound);
      EXPECT_LE(distance, node.inaccuracy + 1e-12);
    }
  }
}

// Around a gap the ball's centre says little: the search over the ball is what counts.
TEST(Measure, StoresTheTighterBoundOverTheBall) {
  const Surface surface(u_shape(0.3));
  SphereTree tree = octree(surface);
  measure(tree, surface);
  int tighter = 0;
  for (const SphereNode& node : tree.nodes) {
    const double cheap = distance_bound(node.center_distance, node.sphere.radius);
    EXPECT_LE(node.distance_bound, cheap);
    tighter += node.distance_bound < 0.9 * cheap;
  }
  EXPECT_GT(tighter, 10);
}

TEST(Measure, FallsBackToTheDistanceBoundOnAnOpenSurface) {
  const Surface surface(open_box());
  SphereTree tree = octree(surface);
  measure(tree, surface);
  for (const SphereNode& node : tree.nodes) {
    EXPECT_EQ(node.inaccuracy, node.distance_bound);
    EXPECT_GE(node.distance_bound, node.sphere.radius);
  }
}

TEST(Measure, TheInaccuracyAloneIsTheSame) {
  for (const TriangleMesh& mesh : {u_shape(0.3), open_box()}) {
    const Surface surface(mesh);
    SphereTree whole = octree(surface), part = whole;
    measure(whole, surface);
    measure_inaccuracy(part, surface);
    for (std::size_t i = 0; i < whole.nodes.size(); ++i) {
      EXPECT_EQ(part.nodes[i].inaccuracy, whole.nodes[i].inaccuracy);
      EXPECT_EQ(part.nodes[i].distance_bound, SphereNode{}.distance_bound);
    }
  }
}

TEST(Measure, TakesTheNumbersOfSpheresThatAreKnown) {
  const Surface surface(u_shape(0.3));
  SphereTree whole = octree(surface), part = whole, known = whole;
  measure(whole, surface);
  measure(known, surface);
  known.nodes.resize(known.nodes.size() / 2);
  for (SphereNode& node : known.nodes) node.inaccuracy += 1;
  measure_inaccuracy(part, surface, {}, known);
  for (std::size_t i = 0; i < whole.nodes.size(); ++i)
    EXPECT_EQ(part.nodes[i].inaccuracy, whole.nodes[i].inaccuracy + (i < known.nodes.size() ? 1 : 0));
}

}  // namespace
}  // namespace orchard
