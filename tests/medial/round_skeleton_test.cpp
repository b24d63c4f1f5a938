// Curve skeletons of solids that are round, or nearly.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "known_axes.h"
#include "orchard/medial/curve_skeleton.h"
#include "skeletons.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kPi = std::numbers::pi;

// Along a quarter of a circle of radius 2 around z, with flat ends.
TriangleMesh bent_tube(int around, int across, double radius) {
  TriangleMesh mesh;
  for (int i = 0; i <= around; ++i) {
    const double turn = kPi / 2 * i / around;
    const Vector outward(std::cos(turn), std::sin(turn), 0);
    for (int k = 0; k < across; ++k) {
      const double angle = 2 * kPi * k / across;
      mesh.vertices.push_back((2 + radius * std::cos(angle)) * outward + radius * std::sin(angle) * Vector::UnitZ());
    }
  }
  const Index a = static_cast<Index>(across), n = static_cast<Index>(around);
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < a; ++k) {
      const Index next = (k + 1) % a;
      mesh.triangles.push_back({i * a + k, (i + 1) * a + next, i * a + next});
      mesh.triangles.push_back({i * a + k, (i + 1) * a + k, (i + 1) * a + next});
    }
  }
  for (Index k = 1; k + 1 < a; ++k) {
    mesh.triangles.push_back({0, k, k + 1});
    mesh.triangles.push_back({n * a, n * a + k + 1, n * a + k});
  }
  if (Surface(mesh).report().volume < 0) mesh = test::mirrored(mesh);
  return mesh;
}

// Between z = -1 and 1, with half balls of radius `radius` at both ends.
TriangleMesh capsule(double radius, int around) {
  std::vector<std::array<double, 2>> profile;
  const int steps = around / 4;
  for (int i = 0; i <= steps; ++i) {
    const double turn = kPi / 2 * i / steps;
    profile.push_back({i == 0 ? 0 : radius * std::sin(turn), -1 - radius * std::cos(turn)});
  }
  for (int i = steps; i >= 0; --i) {
    const double turn = kPi / 2 * i / steps;
    profile.push_back({i == 0 ? 0 : radius * std::sin(turn), 1 + radius * std::cos(turn)});
  }
  return test::turned(profile, around);
}

TEST(RoundSkeleton, OfACylinderIsTheCurveOfItsAxis) {
  const test::KnownAxis cylinder = test::known_cylinder(48, 5);
  const CurveSkeleton skeleton = curve_skeleton(Surface(cylinder.solid), cylinder.axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_TRUE(skeleton.arcs[0].of_axis);
  EXPECT_NEAR(skeleton.arcs[0].length, 3, 1e-9);
  EXPECT_EQ(skeleton.max_moved, 0);
  EXPECT_EQ(skeleton.axis_distance, 0);
}

TEST(RoundSkeleton, OfABallIsAPoint) {
  const test::KnownAxis ball = test::known_sphere(3);
  const CurveSkeleton skeleton = curve_skeleton(Surface(ball.solid), ball.axis);
  EXPECT_EQ(skeleton.vertices.size(), 1u);
  EXPECT_TRUE(skeleton.arcs.empty());
  EXPECT_EQ(skeleton.nodes.size(), 1u);
  const Surface sampled(test::icosphere(4));
  EXPECT_EQ(curve_skeleton(sampled, test::refined_axis(sampled)).vertices.size(), 1u);
}

TEST(RoundSkeleton, OfATorusIsItsCircle) {
  const test::KnownAxis torus = test::known_torus(96, 32);
  const CurveSkeleton skeleton = curve_skeleton(Surface(torus.solid), torus.axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_EQ(skeleton.arcs[0].from, skeleton.arcs[0].to);
  EXPECT_TRUE(std::isinf(skeleton.arcs[0].significance));
  EXPECT_EQ(test::topology_of(skeleton), (Topology{.components = 1, .loops = 1, .cavities = 0}));
}

TEST(RoundSkeleton, OfABentTubeIsItsCentreLine) {
  const Surface tube(bent_tube(48, 24, 0.3));
  const MedialMesh axis = test::refined_axis(tube);
  const CurveSkeleton skeleton = curve_skeleton(tube, axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_NEAR(skeleton.arcs[0].length, kPi - 0.6, 0.15);
  for (std::size_t i = 0; i < skeleton.vertices.size(); ++i) {
    const Point& p = skeleton.vertices[i];
    const double turn = std::atan2(p.y(), p.x()), to_end = std::min(std::tan(turn), 1 / std::tan(turn)) * 2;
    if (to_end < 0.35) continue;  // beyond, the ends shape the axis
    EXPECT_LT(std::hypot(p.head<2>().norm() - 2, p.z()), 0.01);
    EXPECT_NEAR(skeleton.radii[i], 0.3, 0.01);
  }
}

TEST(RoundSkeleton, OfACapsuleEndsAtTheCentresOfItsEnds) {
  const Surface solid(capsule(0.4, 48));
  const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_NEAR(skeleton.arcs[0].length, 2, 3 * skeleton.edge_length);
  for (const Point& vertex : skeleton.vertices)
    EXPECT_LT(test::distance_to_segment(vertex, Point(0, 0, -1), Point(0, 0, 1)), 2 * skeleton.edge_length);
}

TEST(RoundSkeleton, OfAPolyhedralBallOrCapsuleHasNoBranchesIntoItsCorners) {
  // The axes of such meshes have sheets into every edge, which come from the centres of the ends.
  const Surface solid(capsule(0.8, 16));
  const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_NEAR(skeleton.arcs[0].length, 2, 3 * skeleton.edge_length);
}

TEST(RoundSkeleton, OfACylinderEndsWhereItsFlatEndsAreAsFarAsItsWall) {
  for (const auto& [radius, sides] : {std::pair{0.8, 24}, {0.8, 48}}) {
    const Surface solid(test::turned({{radius, 0}, {radius, 4}}, sides));
    const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid));
    ASSERT_EQ(skeleton.arcs.size(), 1u) << radius << " " << sides;
    EXPECT_NEAR(skeleton.arcs[0].length, 4 - 2 * radius, 3 * skeleton.edge_length) << radius << " " << sides;
    for (const Point& vertex : skeleton.vertices)
      EXPECT_LT(test::distance_to_segment(vertex, Point(0, 0, radius), Point(0, 0, 4 - radius)),
                2 * skeleton.edge_length)
          << radius << " " << sides;
  }
}

TEST(RoundSkeleton, OfAConeReachesItsTip) {
  const Surface solid(test::turned({{0, 0}, {0.5, 1.5}}, 38));
  const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  const double middle = 1.5 - 0.5 * 1.5 / (0.5 + std::hypot(0.5, 1.5));  // of the ball that touches the base
  EXPECT_NEAR(skeleton.arcs[0].length, middle, 3 * skeleton.edge_length);
}

TEST(RoundSkeleton, OfAFrustumOfAConeIsOnItsAxis) {
  const Surface solid(test::turned({{0.2, 0}, {0.6, 4}}, 48));
  const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_GT(skeleton.arcs[0].length, 3);
  for (std::size_t i = 0; i < skeleton.vertices.size(); ++i) {
    const double z = skeleton.vertices[i].z();
    if (z < 0.3 || z > 3.4) continue;  // beyond, the ends shape the axis
    EXPECT_LT(skeleton.vertices[i].head<2>().norm(), 0.03);
    const double slope = 0.1, across = 0.2 + slope * z;  // to the wall, inclined by that
    EXPECT_NEAR(skeleton.radii[i], across / std::sqrt(1 + slope * slope), 0.03);
  }
}

TEST(RoundSkeleton, OfAPlateWithAHoleIsALoopBetweenBothRims) {
  // A ring with a flat cross-section: radii 1 to 3, height 0.4.
  TriangleMesh mesh = test::torus(64, 4, 2, 1);
  for (Point& vertex : mesh.vertices) {
    const double z = vertex.z(), r = vertex.head<2>().norm();
    const double turned = r - 2 + z, other = z - (r - 2);  // the square cross-section stands on a corner
    vertex.head<2>() *= (2 + (turned > 0.5 ? 1 : -1)) / r;
    vertex.z() = other > 0.5 ? 0.2 : -0.2;
  }
  const Surface solid(mesh);
  ASSERT_TRUE(solid.solid());
  const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid, 4000));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_EQ(test::topology_of(skeleton), (Topology{.components = 1, .loops = 1, .cavities = 0}));
  for (const Point& vertex : skeleton.vertices) {
    EXPECT_NEAR(vertex.head<2>().norm(), 2, 2 * skeleton.edge_length);
    EXPECT_NEAR(vertex.z(), 0, 0.01);
  }
}

// Prisms and their like with few facets: each facet's edge has a sheet, and these meet the sheets at the flat ends in
// lines that lead into the corners.
TEST(RoundSkeleton, OfACoarseCylinderEndsWhereItsSheetsTurn) {
  for (const auto& [sides, length] : {std::pair{8, 4.0}, {12, 4.0}}) {
    const Surface solid(test::turned({{1, 0}, {1, length}}, sides));
    const CurveSkeleton skeleton = curve_skeleton(solid, test::refined_axis(solid, 5000));
    const double radius = std::cos(kPi / sides);  // of the largest ball
    ASSERT_EQ(skeleton.arcs.size(), 1u) << sides << " " << length;
    EXPECT_NEAR(skeleton.arcs[0].length, length - 2 * radius, 3 * skeleton.edge_length) << sides << " " << length;
    for (const Point& vertex : skeleton.vertices)
      EXPECT_LT(test::distance_to_segment(vertex, Point(0, 0, radius), Point(0, 0, length - radius)),
                2 * skeleton.edge_length)
          << sides << " " << length;
  }
}

}  // namespace
}  // namespace orchard
