#include "orchard/spheretree/ball_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/random.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/tree_file.h"
#include "support.h"
#include "support/query_of_trees.h"

namespace orchard {
namespace {

std::vector<Sphere> random_balls(Index count, std::uint64_t seed, const Vector& offset = Vector::Zero()) {
  Random random(seed, 1);
  std::vector<Sphere> balls;
  for (Index i = 0; i < count; ++i) {
    const Vector at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    balls.push_back({at + offset, random.uniform(0.02, 0.2)});
  }
  return balls;
}

TEST(BallTree, HoldsEachBallInAllThatIsAboveIt) {
  for (const Index count : {1u, 2u, 8u, 9u, 137u}) {
    const std::vector<Sphere> balls = random_balls(count, count);
    const SphereTree tree = ball_tree(balls);
    validate(tree);
    Index leaves = 0;
    for (const SphereNode& node : tree.nodes) {
      if (node.child_count > 0) continue;
      ++leaves;
      EXPECT_GE(node.level + 1, tree.depth());
      for (Index above = node.parent; above != kNone; above = tree.nodes[above].parent) {
        const Sphere& holder = tree.nodes[above].sphere;
        EXPECT_LE((holder.center - node.sphere.center).norm() + node.sphere.radius, holder.radius);
      }
    }
    EXPECT_EQ(leaves, count);
  }
}

TEST(BallTree, HasAllLeavesOnOneLevelWhereBranchingIsWide) {
  const SphereTree tree = ball_tree(random_balls(40, 3), 40);
  EXPECT_EQ(tree.depth(), 1);
  EXPECT_EQ(tree.nodes.size(), 41);
}

TEST(PackBalls, IsProvenWhereverTheBallsAre) {
  for (const double away : {0.0, 1e3, 1e6}) {
    const BallTree tree = pack_balls(random_balls(200, 7, Vector(away, -away, away)));
    EXPECT_EQ(tree.balls_unproven, 0) << away;
    EXPECT_EQ(tree.bounds_unproven, 0) << away;
    EXPECT_EQ(runtime::structure_fault(tree.packed), nullptr);
  }
}

TEST(PackBalls, CanBeWrittenAndRead) {
  const BallTree tree = pack_balls(random_balls(50, 2));
  runtime::PackedSphereTree read;
  ASSERT_EQ(runtime::load(runtime::serialize(tree.packed), read), runtime::LoadStatus::ok);
  EXPECT_EQ(read.node_count, tree.packed.node_count);
  EXPECT_TRUE(read.triangles.empty());
}

// The smallest gap between balls of the two sets, below 0 where some overlap.
double gap_between(const std::vector<Sphere>& a, const std::vector<Sphere>& b, const Vector& shift) {
  double gap = std::numeric_limits<double>::infinity();
  for (const Sphere& x : a)
    for (const Sphere& y : b) gap = std::min(gap, (x.center - y.center - shift).norm() - x.radius - y.radius);
  return gap;
}

TEST(PackBalls, AnswersAsAllPairsOfBallsDo) {
  const std::vector<Sphere> a = random_balls(60, 11), b = random_balls(45, 12);
  const BallTree tree_a = pack_balls(a), tree_b = pack_balls(b);
  runtime::test::OwnNarrowPhase narrow(tree_a.packed, tree_b.packed, 1u << 16);
  Index apart = 0, touching = 0;
  for (Index i = 0; i < 400; ++i) {
    Random random(5, i);
    const Vector shift(random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5), random.uniform(-2.5, 2.5));
    const double gap = gap_between(a, b, shift);
    if (std::abs(gap) < 1e-5) continue;  // floats
    narrow.start({}, *runtime::pose_from_quaternion({1, 0, 0, 0}, {shift.x(), shift.y(), shift.z()}));
    while (!narrow.finished()) narrow.refine();
    EXPECT_EQ(narrow.answer(), gap > 0 ? runtime::Answer::no : runtime::Answer::maybe) << shift.transpose();
    EXPECT_LE(narrow.lower_bound(), std::max(0.0, gap) + 1e-5);
    gap > 0 ? ++apart : ++touching;
  }
  EXPECT_GT(apart, 50);
  EXPECT_GT(touching, 50);
}

}  // namespace
}  // namespace orchard
