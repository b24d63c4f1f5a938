// Distances, rays, capsules and insides at every size that a tree may have.
#include <gtest/gtest.h>

#include <cmath>

#include "lattice_scene.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/shape_query.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

TEST(Scale, DistancesHoldAtEveryPowerOfTwoOfTheRange) {
  for (std::uint64_t seed = 300; seed < 304; ++seed) {
    const Scene s = scene(seed);
    const PackedSphereTree a = tree_of(s.a, 0), b = tree_of(s.b, 0);
    Draw draw(seed);
    for (int i = 0; i < 2; ++i) {
      const Pose pose = draw.pose(draw.uniform(4, 20));
      const auto truth = static_cast<double>(surface_distance(placed_triangles(a, {}), placed_triangles(b, pose)));
      for (int power = kMinPower; power <= kMaxPower; ++power) {
        const PackedSphereTree large_a = tree_of(s.a, power), large_b = tree_of(s.b, power);
        Pose at = pose;
        for (double& x : at.translation) x = std::ldexp(x, power);
        test::OwnDistanceQuery query(large_a, large_b);
        query.start({}, at);
        query.refine();
        ASSERT_TRUE(query.finished());
        const double unit = std::ldexp(1, power), near = 1e-9 * unit;
        ASSERT_LE(query.lower(), truth * unit + near) << seed << " 2^" << power;
        ASSERT_GE(query.upper(), truth * unit - near) << seed << " 2^" << power;
        ASSERT_LE(query.upper(), 1.01 * query.lower() + 1e-5 * unit) << seed << " 2^" << power;
      }
    }
  }
}

TEST(Scale, RaysCapsulesAndInsidesAreTheSameAtEveryPowerOfTwoOfTheRange) {
  int hits = 0, misses = 0;
  const LatticeMesh cube = lattice_box({4, 3, 2});
  for (int power = kMinPower; power <= kMaxPower; ++power) {
    const PackedSphereTree tree = tree_of(cube, power);
    const double unit = std::ldexp(1, power);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Draw draw(seed);
      // From lattice points to lattice points: which of them are inside, or on the surface, is plain.
      Lattice p{}, q{};
      for (Lattice* v : {&p, &q}) {
        for (std::int64_t& x : *v) x = static_cast<std::int64_t>(draw.bits() % 8) - 2;
      }
      const LatticeTriangle segment = {p, q, q};
      const bool touch = meet({segment}, cube);
      (touch ? hits : misses) += 1;
      Vec from{}, to{}, way{};
      for (std::size_t i = 0; i < 3; ++i) {
        from[i] = static_cast<double>(p[i]) * unit, to[i] = static_cast<double>(q[i]) * unit;
        way[i] = static_cast<double>(q[i] - p[i]);
      }
      ASSERT_EQ(cast_ray(tree, {}, from, way, unit).has_value(), touch) << seed << " 2^" << power;
      const SurfacePoint near = nearest_point_to_segment(tree, {}, from, to, 0);
      ASSERT_EQ(near.triangle != kNoTriangle, touch) << seed << " 2^" << power;
      const SurfacePoint all = nearest_point_to_segment(tree, {}, from, to);
      ASSERT_EQ(all.distance == 0, touch) << seed << " 2^" << power;
      const auto strictly = [&p](std::int64_t x, std::int64_t y, std::int64_t z) {
        return p[0] > 0 && p[0] < x && p[1] > 0 && p[1] < y && p[2] > 0 && p[2] < z;
      };
      const bool outside = p[0] < 0 || p[0] > 4 || p[1] < 0 || p[1] > 3 || p[2] < 0 || p[2] > 2;
      if (strictly(4, 3, 2)) {
        ASSERT_TRUE(contains(tree, {}, from)) << seed << " 2^" << power;
      }
      if (outside) {
        ASSERT_FALSE(contains(tree, {}, from)) << seed << " 2^" << power;
      }
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
}

TEST(Scale, OfADirectionChangesNoRay) {
  const PackedSphereTree cube = tree_of(lattice_box({2, 2, 2}), 0);
  for (const double scale : {1.0, 0x1p-300, 0x1p300}) {
    Pose pose;
    pose.scale = scale;
    for (int power = -1070; power <= 1020; ++power) {
      const double speed = std::ldexp(1, power);
      const auto hit = cast_ray(cube, pose, {scale, 0.5 * scale, -scale}, {0, 0, speed});
      ASSERT_TRUE(hit) << scale << " 2^" << power;
      ASSERT_EQ(hit->point, (Vec{scale, 0.5 * scale, 0}));
      ASSERT_EQ(hit->along, scale / speed) << scale << " 2^" << power;  // infinite where no double says it
      ASSERT_FALSE(cast_ray(cube, pose, {scale, 0.5 * scale, -scale}, {0, 0, -speed})) << scale << " 2^" << power;
      const double half = 0.5 * scale / speed;
      if (half > 0 && std::isfinite(half)) {
        ASSERT_FALSE(cast_ray(cube, pose, {scale, 0.5 * scale, -scale}, {0, 0, speed}, half)) << power;
      }
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
