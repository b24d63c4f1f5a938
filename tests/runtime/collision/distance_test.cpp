#include "orchard/runtime/distance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "allocation.h"
#include "bodies.h"
#include "collision/kernels/triangle_block.h"
#include "collision/triangle_distance.h"
#include "every_machine.h"
#include "simd/machine.h"
#include "support/effort.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

struct DistanceScene {
  std::size_t a, b;
  Pose pose_a, pose_b;
};

DistanceScene random_scene(const std::vector<Body>& all, std::uint64_t seed, double spread) {
  Draw draw(seed);
  DistanceScene s{draw.bits() % all.size(), draw.bits() % all.size(), {}, {}};
  const PackedSphereTree &a = all[s.a].tree, &b = all[s.b].tree;
  s.pose_a = centered(a, draw.pose(0));
  s.pose_b = centered(b, draw.pose(draw.uniform(0, spread) * (a.bounding_radius + b.bounding_radius)));
  return s;
}

TEST(Distance, ClosesInOnTheTruthFromBothSides) {
  const auto all = bodies();
  int apart = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const DistanceScene s = random_scene(all, seed, 2);
    const double truth = static_cast<double>(
        surface_distance(placed_triangles(all[s.a].tree, s.pose_a), placed_triangles(all[s.b].tree, s.pose_b)));
    const double rounding = 4e-6;  // nearly parallel edges
    test::OwnDistanceQuery query(all[s.a].tree, all[s.b].tree);
    query.start(s.pose_a, s.pose_b, {.relative = seed % 2 == 0 ? 0.01 : 0.0});
    double lower = query.lower(), upper = query.upper();
    for (;;) {
      ASSERT_LE(query.lower(), truth + 1e-12);
      ASSERT_GE(query.upper(), truth - 1e-12);
      ASSERT_GE(query.lower(), lower);
      ASSERT_LE(query.upper(), upper);
      lower = query.lower(), upper = query.upper();
      if (query.finished()) break;
      query.refine({.work = 1 + seed % 200});
    }
    ASSERT_LE(upper, lower * (seed % 2 == 0 ? 1.01 : 1) + rounding * (1 + truth));
    const auto points = query.points();
    ASSERT_NEAR(
        std::hypot(points.on_a[0] - points.on_b[0], points.on_a[1] - points.on_b[1], points.on_a[2] - points.on_b[2]),
        upper, 1e-7);
    const auto ta = placed_triangles(all[s.a].tree, s.pose_a).at(points.triangle_a);
    ASSERT_LE(point_distance({points.on_a[0], points.on_a[1], points.on_a[2]}, ta), 1e-8);
    apart += truth > 0;
  }
  EXPECT_GT(apart, 100);
}

TEST(Distance, IsTheSameHoweverItIsCutAndWhicheverBodyComesFirst) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const DistanceScene s = random_scene(all, seed, 1.5);
    test::OwnDistanceQuery whole(all[s.a].tree, all[s.b].tree), back(all[s.b].tree, all[s.a].tree);
    whole.start(s.pose_a, s.pose_b), back.start(s.pose_b, s.pose_a);
    const std::size_t before = allocations;
    whole.refine();
    while (!back.finished()) back.refine({.work = 40});
    ASSERT_EQ(allocations, before);
    ASSERT_EQ(whole.lower(), back.lower()) << seed;
    ASSERT_EQ(whole.upper(), back.upper()) << seed;
    ASSERT_EQ(whole.work(), back.work()) << seed;
    ASSERT_EQ(whole.points().on_a, back.points().on_b) << seed;
    ASSERT_EQ(whole.points().triangle_a, back.points().triangle_b) << seed;
  }
}

TEST(Distance, WithoutTrianglesKeepsToTheRoots) {
  const auto none = build_tree(Mesh{}), cube = build_tree(box({0, 0, 0}, {1, 1, 1}));
  test::OwnDistanceQuery query(none, cube);
  query.start({}, Pose{.translation = {5, 0, 0}});
  EXPECT_TRUE(query.finished());
  EXPECT_GT(query.lower(), 3);
  EXPECT_EQ(query.points().triangle_a, kNoTriangle);
}

TEST(Distance, OfTouchingBodiesIsZero) {
  const auto cube = build_tree(box({0, 0, 0}, {1, 1, 1}));
  test::OwnDistanceQuery query(cube, cube);
  query.start({}, Pose{.translation = {0.5, 0.25, 1}});
  query.refine();
  EXPECT_TRUE(query.finished());
  EXPECT_EQ(query.lower(), 0);
  EXPECT_LT(query.upper(), 1e-9);
}

TEST(TriangleDistance, AgreesWithBruteForceAlsoForNeedlesAndParallelEdges) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Draw draw(seed);
    detail::TrianglePoints a{}, b{};
    Triangle la{}, lb{};
    const double thin = std::pow(10, -draw.uniform(0, 9));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec p = draw.direction(), q = draw.direction();
      a[k] = {p[0], thin * p[1], thin * p[2]};
      b[k] = {q[0] + 0.5, thin * q[1] + 0.3, draw.bits() % 2 == 0 ? 0 : thin * q[2]};
      for (std::size_t i = 0; i < 3; ++i) la[k][i] = a[k][i], lb[k][i] = b[k][i];
    }
    if (detail::triangles_intersect(a, b, nullptr)) continue;
    const double truth = static_cast<double>(triangle_distance(la, lb));
    const double found = detail::nearest_points(a, b).distance;
    ASSERT_GE(found, truth - 1e-12) << seed;
    ASSERT_LE(found, truth + detail::kParallelError * (detail::longest_edge(a) + detail::longest_edge(b))) << seed;
  }
}

// Also where several places are equally near, and where triangles and segments are points: the first one counts.
TEST(TriangleDistance, IsTheSameOnEveryMachine) {
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 4000 * orchard::test::more(); ++seed) {
    Draw draw(seed);
    const auto coordinate = [&]() -> double {
      return seed % 2 == 0 ? static_cast<double>(draw.bits() % 4) : draw.uniform(-1, 1);
    };
    const auto point = [&]() -> Vec3 { return {coordinate(), coordinate(), coordinate()}; };
    detail::TrianglePoints a = {point(), point(), point()}, b = {point(), point(), point()};
    if (seed % 8 == 2) b[1] = b[0];
    if (seed % 16 == 2) b[2] = b[0];
    const Vec3 p = point(), q = seed % 8 == 4 ? p : point();
    std::array<detail::NearestPoints, 3> first{};
    bool any = false;
    on_every_machine([&] {
      const std::array<detail::NearestPoints, 3> found = {detail::nearest_points(a, b), detail::nearest_points(p, p, b),
                                                          detail::nearest_points(p, q, b)};
      if (!any) first = found, any = true;
      for (std::size_t i = 0; i < found.size(); ++i) {
        ASSERT_EQ(found[i].distance, first[i].distance) << seed << " " << i;
        ASSERT_EQ(found[i].on_a, first[i].on_a) << seed << " " << i;
        ASSERT_EQ(found[i].on_b, first[i].on_b) << seed << " " << i;
      }
    });
    if (HasFatalFailure()) return;
  }
}

TEST(TriangleGaps, NeverExceedTheDistanceAndAreTheSameWithoutVectors) {
  int tight = 0, far = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Draw draw(seed);
    const auto a = build_tree(soup(2 * seed, 6), {.leaf_triangles = 8, .bounds = false}),
               b = build_tree(soup(2 * seed + 1, 7), {.leaf_triangles = 8, .bounds = false});
    const TriangleBlock lanes = one_block(a), rows = one_block(b);
    const Pose pose = draw.pose(draw.uniform(0, 4));
    detail::Placement placement{};
    for (std::size_t i = 0; i < 9; ++i) placement.rotation[i] = static_cast<float>(pose.rotation[i]);
    for (std::size_t i = 0; i < 3; ++i) placement.translation[i] = static_cast<float>(pose.translation[i]);
    placement.margin = 1e-4f;
    const Vec d = draw.direction();
    const std::array<float, 3> direction = {static_cast<float>(d[0]), static_cast<float>(d[1]),
                                            static_cast<float>(d[2])};
    // How far apart triangles may be to be told exactly: all, most and some of these.
    const float reach = seed % 4 == 0 ? 1e30f : static_cast<float>(draw.uniform(0, 3));
    detail::TriangleGaps gaps{}, plain{};
    ask_portably([&] { detail::triangle_gaps(lanes, rows, placement, direction, reach, plain); });
    for (const detail::Machine m : {detail::Machine::base, detail::Machine::avx2, detail::Machine::avx512}) {
      if (m > detail::best_machine()) break;
      detail::use_machine(m);
      detail::triangle_gaps(lanes, rows, placement, direction, reach, gaps);
      for (std::size_t r = 0; r < 7; ++r) {
        for (std::size_t l = 0; l < 6; ++l) ASSERT_EQ(gaps.lower[r][l], plain.lower[r][l]) << seed;
      }
      ASSERT_EQ(gaps.near, plain.near) << seed;
      ASSERT_EQ(gaps.beyond, plain.beyond) << seed;
    }
    far += gaps.near == std::array<std::uint32_t, kBlockWidth>{};
    float beyond = std::numeric_limits<float>::infinity();
    for (std::size_t r = 0; r < 7; ++r) {
      for (std::size_t l = 0; l < 6; ++l) {
        ASSERT_EQ(gaps.near[r] >> l & 1, gaps.lower[r][l] <= reach ? 1u : 0u) << seed;
        if (gaps.lower[r][l] > reach) beyond = std::min(beyond, gaps.lower[r][l]);
      }
      ASSERT_EQ(gaps.near[r] >> 6, 0u);
    }
    ASSERT_EQ(gaps.near[7], 0u);
    ASSERT_EQ(gaps.beyond, beyond) << seed;
    const auto pa = placed_triangles(a, {}), pb = placed_triangles(b, pose);
    for (std::size_t r = 0; r < 7; ++r) {
      for (std::size_t l = 0; l < 6; ++l) {
        const auto truth = triangle_distance(pa[lanes.triangle[l]], pb[rows.triangle[r]]);
        ASSERT_LE(gaps.lower[r][l], truth) << seed;
        tight += reach > 1e29f && gaps.lower[r][l] > 0.9 * static_cast<double>(truth);
      }
    }
  }
  EXPECT_GT(tight, 1250);
  EXPECT_GT(far, 50);
}

}  // namespace
}  // namespace orchard::runtime
