// Every query, asked with poses that name no place: nothing is known, no contact is missed, nothing crashes.
#include <gtest/gtest.h>

#include "bodies.h"
#include "improper_poses.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/shape_query.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_nothing_known(const NarrowPhase& query) {
  ASSERT_EQ(query.answer(), Answer::maybe);
  ASSERT_TRUE(query.finished());
  ASSERT_TRUE(query.refused());
  ASSERT_EQ(query.separation_bound(), kInfinity);
  ASSERT_EQ(query.lower_bound(), 0);
  const Verdict verdict = query.verdict();
  ASSERT_EQ(verdict.contact.center, Contact{}.center);
  ASSERT_EQ(verdict.contact.triangle_a, kNoTriangle);
}

TEST(ImproperPose, IsAnsweredByMaybeAndNothingElse) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    SCOPED_TRACE(seed);
    Draw draw(seed);
    const PackedSphereTree &a = all[draw.bits() % all.size()].tree, &b = all[draw.bits() % all.size()].tree;
    test::OwnNarrowPhase query(a, b, 64);
    test::OwnDistanceQuery distance(a, b);
    const Pose proper = centered(a, draw.pose(0)), at = centered(b, draw.pose(draw.uniform(0, 5)));
    for (const auto& [name, pose] : improper_poses(at)) {
      SCOPED_TRACE(name);
      for (const bool first : {false, true}) {
        const Pose &p = first ? pose : proper, &q = first ? proper : pose;
        ASSERT_EQ(query.start(p, q), Answer::maybe);
        expect_nothing_known(query);
        query.refine(), query.refine_exactly();
        expect_nothing_known(query);
        ASSERT_EQ(collide(query, p, q, {.work = 100}).answer, Answer::maybe);
        ASSERT_EQ(collide(query, p, q).answer, Answer::maybe);
        distance.start(p, q);
        distance.refine();
        ASSERT_TRUE(distance.finished());
        ASSERT_EQ(distance.lower(), 0);
        ASSERT_EQ(distance.upper(), kInfinity);
        ASSERT_EQ(distance.points().triangle_a, kNoTriangle);
        if (HasFatalFailure()) return;
      }
    }
    query.start(proper, at);  // and a proper one is answered again
    ASSERT_FALSE(query.refused());
    while (!query.finished()) query.refine();
    ASSERT_NE(query.answer(), Answer::maybe);
  }
}

TEST(ImproperPose, NeverHidesAShape) {
  const auto tree = build_tree(box({0, 0, 0}, {1, 1, 1}));
  Draw draw(1);
  const Vec far = {9, 9, 9}, farther = {10, 9, 9};
  const auto expect_unknown = [&](const Pose& pose, const Vec& p, const Vec& q, double length) {
    const SurfacePoint near = nearest_point_to_segment(tree, pose, p, q, length);
    ASSERT_EQ(near.distance, 0);
    ASSERT_EQ(near.triangle, kNoTriangle);
    const auto hit = cast_ray(tree, pose, p, q, length);
    ASSERT_TRUE(hit);
    ASSERT_EQ(hit->along, 0);
    ASSERT_EQ(hit->triangle, kNoTriangle);
  };
  for (const auto& [name, pose] : improper_poses(draw.pose(1))) {
    SCOPED_TRACE(name);
    expect_unknown(pose, far, farther, 0.1);
    ASSERT_TRUE(contains(tree, pose, far));
    ASSERT_TRUE(contains_solid(tree, {}, tree, pose));
    ASSERT_TRUE(contains_solid(tree, pose, tree, {}));
    ASSERT_FALSE(can_ask(tree, pose, far));
    if (HasFatalFailure()) return;
  }
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), kInfinity, -kInfinity, 1e101}) {
    for (std::size_t i = 0; i < 3; ++i) {
      Vec p = far;
      p[i] = bad;
      expect_unknown({}, p, farther, 0.1);
      ASSERT_EQ(nearest_point_to_segment(tree, {}, far, p, 0.1).distance, 0);
      ASSERT_TRUE(contains(tree, {}, p));
      ASSERT_FALSE(can_ask(tree, {}, p));
      if (!(std::fabs(bad) < kInfinity)) {
        ASSERT_EQ(cast_ray(tree, {}, far, p)->triangle, kNoTriangle);
      }
    }
  }
  expect_unknown({}, far, farther, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(cast_ray(tree, {}, {0.5, 0.5, -1}, {0, 0, 1}, -1));
  EXPECT_TRUE(can_ask(tree, {}, far));
}

// The bodies are so far apart, or so different in size, that no float could say how.
TEST(NarrowPhase, RefusesBodiesBeyondTheRangeOfFloatsAndNeverSaysNoThere) {
  PackedSphereTree cube = build_tree(box({0, 0, 0}, {1, 1, 1}));
  test::OwnNarrowPhase query(cube, cube, 64);
  Pose small, large;
  large.scale = 0x1p50, large.translation = {-0x1p49, -0x1p49, -0x1p49};  // around the small one
  EXPECT_EQ(query.start(small, large), Answer::maybe);
  EXPECT_TRUE(query.refused());
  cube.origin = {1e18, 0, 0};  // and its instance as far the other way, by a pose and by an origin
  PackedSphereTree other = build_tree(box({0, 0, 0}, {1, 1, 1}));
  test::OwnNarrowPhase far(cube, other, 64);
  Pose near;
  near.translation = {1e18, 0, 0};
  far.start({}, near);
  while (!far.finished()) far.refine();
  EXPECT_NE(far.answer(), Answer::no);
  near.scale = 1e15;
  EXPECT_NE(far.start({}, near), Answer::no);
}

}  // namespace
}  // namespace orchard::runtime
