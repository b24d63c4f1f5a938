#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies.h"
#include "orchard/runtime/contacts.h"
#include "orchard/runtime/shape_query.h"
#include "support/effort.h"

// Contacts before bodies overlap, where they are nearest, and how deep each point is.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

constexpr double kRounding = 1e-7;  // of coordinates up to some thousands, in the bounds of distances

double size_of(const Vec3& v) { return std::sqrt(dot(v, v)); }

std::array<long double, 3> wide(const Vec3& v) { return {v[0], v[1], v[2]}; }

template <typename Check>
void each_pair(int poses, Check&& check) {
  const auto all = bodies();
  Workspace workspace;
  for (std::size_t i = 0; i < all.size(); i += 2) {
    for (std::size_t j = 0; j < all.size(); j += 3) {
      const PackedSphereTree &a = all[i].tree, &b = all[j].tree;
      const PreparedTree first(a), second(b);
      for (int k = 0; k < poses; ++k) {
        Draw draw(orchard::test::first_seed() + 100 * i + 10 * j + static_cast<std::uint64_t>(k));
        const double size = a.bounding_radius + b.bounding_radius;
        const Pose pose_a = centered(a, draw.pose(0)), pose_b = centered(b, draw.pose(draw.uniform(0.3, 1.2) * size));
        check(workspace, TreePair(first, second), pose_a, pose_b, draw.uniform(0, 0.3) * size);
      }
    }
  }
}

TEST(CloserWithPoints, GivesAPointOfEachSurfaceNoFartherApartThanTheMargin) {
  int closer = 0;
  each_pair(4, [&](Workspace& workspace, const TreePair& pair, const Pose& a, const Pose& b, double margin) {
    const Closeness found = closer_with_points(workspace, pair, a, b, margin);
    EXPECT_EQ(found.answer, closer_than(workspace, pair, a, b, margin));
    if (found.answer != Answer::yes) return;
    ++closer;
    EXPECT_LE(found.distance.upper, margin + kRounding);
    const auto& points = found.distance.points;
    EXPECT_NEAR(size_of(Vec3(points.on_b) - points.on_a), found.distance.upper, kRounding);
    EXPECT_LT(nearest_point(pair.a().tree, a, points.on_a).distance, kRounding);
    EXPECT_LT(nearest_point(pair.b().tree, b, points.on_b).distance, kRounding);
  });
  EXPECT_GT(closer, 10);
}

TEST(ContactMargin, GivesOnePointWhereSurfacesAreNearerThanItByBruteForce) {
  int near = 0, far = 0;
  const auto all = bodies();
  Workspace workspace;
  for (std::uint64_t seed = 0; seed < 60 * orchard::test::more(); ++seed) {
    Draw draw(orchard::test::first_seed() + seed);
    const auto &a = all[seed % all.size()].tree, &b = all[(seed * 5 + 2) % all.size()].tree;
    const PreparedTree first(a), second(b);
    const double size = a.bounding_radius + b.bounding_radius, margin = draw.uniform(0, 0.3) * size;
    const Pose pose_a = centered(a, draw.pose(0)), pose_b = centered(b, draw.pose(draw.uniform(0.6, 1.3) * size));
    const auto placed_a = placed_triangles(a, pose_a), placed_b = placed_triangles(b, pose_b);
    const auto apart = static_cast<double>(surface_distance(placed_a, placed_b));
    const Manifold m = contacts(workspace, TreePair(first, second), pose_a, pose_b, {.margin = margin});
    if (apart == 0) {
      EXPECT_EQ(m.answer, Answer::yes);
      continue;
    }
    ASSERT_EQ(m.answer, Answer::no) << seed;
    if (std::fabs(apart - margin) < 1e-6 * size) continue;
    ASSERT_EQ(m.count, apart < margin ? 1u : 0u) << seed;
    if (m.count == 0) {
      ++far;
      continue;
    }
    ++near;
    EXPECT_GE(-m.depth, apart - kRounding);
    EXPECT_LE(-m.depth, apart * 1.011 + kRounding);
    EXPECT_EQ(m.points[0].depth, m.depth);
    // Half the distance away from both, which b leaves along the normal.
    const auto place = wide(m.points[0].place);
    const auto to = [&](const auto& triangles) {
      long double least = 1e300L;
      for (const Triangle& t : triangles) least = std::min(least, point_distance(place, t));
      return static_cast<double>(least);
    };
    EXPECT_LE(to(placed_a), -m.depth / 2 + kRounding);
    EXPECT_LE(to(placed_b), -m.depth / 2 + kRounding);
    EXPECT_NEAR(size_of(m.normal), 1, 1e-9);
    Pose closer = pose_b;  // by most of the way, along which the rest is left
    closer.translation = Vec3(pose_b.translation) + 0.9 * m.depth * Vec3(m.normal);
    EXPECT_EQ(closer_than(workspace, TreePair(first, second), pose_a, closer, -0.101 * m.depth + kRounding),
              Answer::yes)
        << seed;
  }
  EXPECT_GT(near, 5);
  EXPECT_GT(far, 5);
}

// A crate that stands tilted in the ground: each corner is as deep as it is below.
TEST(ContactDepths, AreThoseOfTheTrianglesThatMeetAtEachPoint) {
  const auto ground = build_tree(box({-2, -2, -1}, {2, 2, 0})),
             crate = build_tree(box({-0.5, -0.25, 0}, {0.5, 0.25, 1}));
  const PreparedTree a(ground), b(crate);
  Workspace workspace;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Draw draw(seed);
    const double tilt = draw.uniform(-0.02, 0.02), depth = 0.03;
    const Pose at_b = *pose_from_quaternion({std::cos(tilt / 2), 0, std::sin(tilt / 2), 0}, {0.2, 0.1, -depth});
    const Manifold m = contacts(workspace, TreePair(a, b), {}, at_b);
    ASSERT_EQ(m.answer, Answer::yes);
    ASSERT_EQ(m.count, 4u);
    for (std::uint32_t i = 0; i < m.count; ++i) {
      const ContactPoint& point = m.points[i];
      double low = 1e300, high = -1e300;
      for (const std::uint32_t v : ground.triangles[point.triangle_a]) {
        const auto& corner = ground.vertices[v];
        const Vec3 place = Vec3{double{corner[0]}, double{corner[1]}, double{corner[2]}} + Vec3(ground.origin);
        high = std::max(high, dot(Vec3(m.normal), place));
      }
      for (const std::uint32_t v : crate.triangles[point.triangle_b]) {
        const auto& corner = crate.vertices[v];
        const Vec3 place =
            transform(at_b, Vec3{double{corner[0]}, double{corner[1]}, double{corner[2]}} + Vec3(crate.origin));
        low = std::min(low, dot(Vec3(m.normal), place));
      }
      EXPECT_NEAR(point.depth, std::min(high - low, m.depth), 1e-12) << seed;
      EXPECT_GT(point.depth, 0);
      EXPECT_LE(point.depth, m.depth);
    }
  }
}

TEST(SignedNearestPoint, IsNegativeInsideAndItsNormalIsWhereTheDistanceGrows) {
  int inside = 0, outside = 0;
  for (const Mesh& mesh : {torus(12, 6, 1, 0.3), l_shape(), spikes(5, 9, 7)}) {
    const auto tree = build_tree(mesh);
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      Draw draw(orchard::test::first_seed() + seed);
      const Pose pose = draw.pose(3);
      const Vec3 point = transform(pose, draw.uniform(0, 1.3) * Vec3(draw.direction()));
      const SignedPoint found = signed_nearest_point(tree, pose, point);
      ASSERT_NE(found.surface.triangle, kNoTriangle);
      long double least = 1e300L;
      for (const Triangle& t : placed_triangles(tree, pose)) least = std::min(least, point_distance(wide(point), t));
      const double sign = contains(tree, pose, point) ? -1 : 1;
      EXPECT_NEAR(found.surface.distance, sign * static_cast<double>(least), 1e-9);
      EXPECT_NEAR(size_of(found.normal), 1, 1e-9);
      const Vec3 back = point - found.surface.distance * Vec3(found.normal);
      EXPECT_LT(size_of(back - found.surface.point), 1e-9);
      sign < 0 ? ++inside : ++outside;
    }
  }
  EXPECT_GT(inside, 5);
  EXPECT_GT(outside, 5);
  const auto tree = build_tree(box({-1, -1, -1}, {1, 1, 1}));
  const SignedPoint on = signed_nearest_point(tree, {}, {0.25, 0.5, 1});
  EXPECT_EQ(on.surface.distance, 0);
  EXPECT_NEAR(on.normal[2], 1, 1e-12);
  EXPECT_EQ(signed_nearest_point(tree, {}, {0, 0, 5}, 1).surface.triangle, kNoTriangle);
}

}  // namespace
}  // namespace orchard::runtime
