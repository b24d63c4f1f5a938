// Curve skeletons of axes and solids that have them in closed form, and of random complexes.
#include "orchard/medial/curve_skeleton.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kPi = std::numbers::pi;

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - (a + t * (b - a))).norm();
}

Topology topology_of(const CurveSkeleton& skeleton) { return topology(medial_mesh(skeleton)); }

MedialMesh axis_of(const Surface& surface, Index points = 2000) {
  MedialBuildOptions options{.refine = RefineOptions{}, .check_promise = false};
  options.sampling.face_points = points - points / 5;
  options.sampling.edge_points = points / 5;
  return medial_mesh(build_medial_axis(surface, options).axis);
}

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

TEST(CurveSkeleton, OfABoxIsTheRidgeOfItsMiddleRectangle) {
  const test::KnownAxis box = test::known_box({1, 2, 4});
  const CurveSkeleton skeleton = curve_skeleton(Surface(box.solid), box.axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_EQ(skeleton.nodes.size(), 2u);
  EXPECT_NEAR(skeleton.arcs[0].length, 2, 3 * skeleton.edge_length);
  for (const Point& vertex : skeleton.vertices)
    EXPECT_LT(distance_to_segment(vertex, Point(0.5, 1, 1), Point(0.5, 1, 3)), 1.5 * skeleton.edge_length);
  for (std::size_t i = 0; i < skeleton.vertices.size(); ++i) EXPECT_NEAR(skeleton.radii[i], 0.5, 1e-9);
  EXPECT_LT(skeleton.axis_distance, 0.05 * skeleton.edge_length);
  EXPECT_LE(skeleton.max_moved, 2 * skeleton.edge_length);
}

TEST(CurveSkeleton, HasABranchIntoEachCornerOfATriangleBelowItsRatio) {
  // The ratio of a corner of 60 degrees is 0.5.
  const Surface solid(test::prism({{{0, 0}, {4, 0}, {2, 2 * std::sqrt(3.0)}}}, {{{0, 1, 2}}}, 0.4));
  const MedialMesh axis = axis_of(solid);
  const CurveSkeleton skeleton = curve_skeleton(solid, axis);
  EXPECT_EQ(skeleton.arcs.size(), 3u);
  const Point middle(2, 2 / std::sqrt(3.0), 0.2);
  for (const auto& arc : skeleton.arcs) {
    const double from = (skeleton.vertices[arc.from] - middle).norm(), to = (skeleton.vertices[arc.to] - middle).norm();
    EXPECT_LT(std::min(from, to), 3 * skeleton.edge_length);
    EXPECT_GT(std::max(from, to), 1);
  }
  EXPECT_EQ(curve_skeleton(solid, axis, {.ratio = 0.75}).vertices.size(), 1u);
}

TEST(CurveSkeleton, OfACylinderIsTheCurveOfItsAxis) {
  const test::KnownAxis cylinder = test::known_cylinder(48, 5);
  const CurveSkeleton skeleton = curve_skeleton(Surface(cylinder.solid), cylinder.axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_TRUE(skeleton.arcs[0].of_axis);
  EXPECT_NEAR(skeleton.arcs[0].length, 3, 1e-9);
  EXPECT_EQ(skeleton.max_moved, 0);
  EXPECT_EQ(skeleton.axis_distance, 0);
}

TEST(CurveSkeleton, OfABallIsAPoint) {
  const test::KnownAxis ball = test::known_sphere(3);
  const CurveSkeleton skeleton = curve_skeleton(Surface(ball.solid), ball.axis);
  EXPECT_EQ(skeleton.vertices.size(), 1u);
  EXPECT_TRUE(skeleton.arcs.empty());
  EXPECT_EQ(skeleton.nodes.size(), 1u);
  const Surface sampled(test::icosphere(4));
  EXPECT_EQ(curve_skeleton(sampled, axis_of(sampled)).vertices.size(), 1u);
}

TEST(CurveSkeleton, OfATorusIsItsCircle) {
  const test::KnownAxis torus = test::known_torus(96, 32);
  const CurveSkeleton skeleton = curve_skeleton(Surface(torus.solid), torus.axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_EQ(skeleton.arcs[0].from, skeleton.arcs[0].to);
  EXPECT_TRUE(std::isinf(skeleton.arcs[0].significance));
  EXPECT_EQ(topology_of(skeleton), (Topology{.components = 1, .loops = 1, .cavities = 0}));
}

TEST(CurveSkeleton, OfABentTubeIsItsCentreLine) {
  const Surface tube(bent_tube(48, 24, 0.3));
  const MedialMesh axis = axis_of(tube);
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

TEST(CurveSkeleton, OfACapsuleEndsAtTheCentresOfItsEnds) {
  const Surface solid(capsule(0.4, 48));
  const CurveSkeleton skeleton = curve_skeleton(solid, axis_of(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_NEAR(skeleton.arcs[0].length, 2, 3 * skeleton.edge_length);
  for (const Point& vertex : skeleton.vertices)
    EXPECT_LT(distance_to_segment(vertex, Point(0, 0, -1), Point(0, 0, 1)), 2 * skeleton.edge_length);
}

TEST(CurveSkeleton, OfAPolyhedralBallOrCapsuleHasNoBranchesIntoItsCorners) {
  // The axes of such meshes have sheets into every edge, which come from the centres of the ends.
  const Surface solid(capsule(0.8, 16));
  const CurveSkeleton skeleton = curve_skeleton(solid, axis_of(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_NEAR(skeleton.arcs[0].length, 2, 3 * skeleton.edge_length);
}

TEST(CurveSkeleton, OfACylinderEndsWhereItsFlatEndsAreAsFarAsItsWall) {
  for (const auto& [radius, sides] : {std::pair{0.8, 24}, {0.8, 48}}) {
    const Surface solid(test::turned({{radius, 0}, {radius, 4}}, sides));
    const CurveSkeleton skeleton = curve_skeleton(solid, axis_of(solid));
    ASSERT_EQ(skeleton.arcs.size(), 1u) << radius << " " << sides;
    EXPECT_NEAR(skeleton.arcs[0].length, 4 - 2 * radius, 3 * skeleton.edge_length) << radius << " " << sides;
    for (const Point& vertex : skeleton.vertices)
      EXPECT_LT(distance_to_segment(vertex, Point(0, 0, radius), Point(0, 0, 4 - radius)), 2 * skeleton.edge_length)
          << radius << " " << sides;
  }
}

TEST(CurveSkeleton, OfAConeReachesItsTip) {
  const Surface solid(test::turned({{0, 0}, {0.5, 1.5}}, 38));
  const CurveSkeleton skeleton = curve_skeleton(solid, axis_of(solid));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  const double middle = 1.5 - 0.5 * 1.5 / (0.5 + std::hypot(0.5, 1.5));  // of the ball that touches the base
  EXPECT_NEAR(skeleton.arcs[0].length, middle, 3 * skeleton.edge_length);
}

TEST(CurveSkeleton, OfAFrustumOfAConeIsOnItsAxis) {
  const Surface solid(test::turned({{0.2, 0}, {0.6, 4}}, 48));
  const CurveSkeleton skeleton = curve_skeleton(solid, axis_of(solid));
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

TEST(CurveSkeleton, OfAPlateWithAHoleIsALoopBetweenBothRims) {
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
  const CurveSkeleton skeleton = curve_skeleton(solid, axis_of(solid, 4000));
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_EQ(topology_of(skeleton), (Topology{.components = 1, .loops = 1, .cavities = 0}));
  for (const Point& vertex : skeleton.vertices) {
    EXPECT_NEAR(vertex.head<2>().norm(), 2, 2 * skeleton.edge_length);
    EXPECT_NEAR(vertex.z(), 0, 0.01);
  }
}

TEST(CurveSkeleton, KeepsAClosedSheetAroundACavity) {
  const TriangleMesh shell = test::joined({test::icosphere(3, 1), test::mirrored(test::icosphere(3, 0.6))});
  const Surface solid(shell);
  ASSERT_TRUE(solid.solid());
  const MedialMesh axis = axis_of(solid);
  ASSERT_EQ(topology(axis), solid_topology(solid));
  const CurveSkeleton skeleton = curve_skeleton(solid, axis);
  EXPECT_FALSE(skeleton.sheets.empty());
  EXPECT_TRUE(skeleton.arcs.empty());
  EXPECT_EQ(topology_of(skeleton), solid_topology(solid));
  EXPECT_NE(to_swc(skeleton).find("triangles of closed sheets"), std::string::npos);
}

// Points of a cloud, joined at random, so that sheets meet in every way.
MedialMesh random_complex(std::uint64_t seed) {
  Random random(seed, 0, 0);
  MedialMesh mesh;
  const Index count = 12 + static_cast<Index>(random.below(20));
  for (Index i = 0; i < count; ++i) {
    mesh.centers.emplace_back(random.uniform(), random.uniform(), random.uniform());
    mesh.radii.push_back(0.05 * random.uniform());
  }
  const auto some = [&] { return static_cast<Index>(random.below(count)); };
  for (Index i = 0; i < 3 * count; ++i) {
    const Index a = some(), b = some(), c = some();
    if (a != b && b != c && a != c && i % 4 != 0) mesh.triangles.push_back({a, b, c});
    if (a != b && i % 4 == 0) mesh.edges.push_back({a, b});
  }
  if (seed % 3 == 0) {  // and a closed surface among them
    const Index first = mesh.size();
    const TriangleMesh box = test::box(Point(0.2, 0.2, 0.2), Point(0.7, 0.8, 0.6));
    mesh.centers.insert(mesh.centers.end(), box.vertices.begin(), box.vertices.end());
    mesh.radii.resize(mesh.centers.size(), 0.01);
    for (const auto& [a, b, c] : box.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
    mesh.edges.push_back({0, first});
  }
  complete(mesh);
  return mesh;
}

TEST(CurveSkeleton, HasTheTopologyOfRandomComplexes) {
  const Surface around(test::box(Point(-1, -1, -1), Point(2, 2, 2)));
  Index loops = 0, cavities = 0;
  for (std::uint64_t seed = 1; seed <= 40 * test::more(); ++seed) {
    const MedialMesh axis = random_complex(seed);
    const CurveSkeleton skeleton = curve_skeleton(around, axis, {.edge_length = 0.02});
    const Topology wanted = topology(axis);
    EXPECT_EQ(topology_of(skeleton), wanted) << "seed " << seed;
    if (wanted.cavities == 0) {
      EXPECT_TRUE(skeleton.sheets.empty()) << "seed " << seed;
      EXPECT_EQ(left_out_of_swc(skeleton).size(), static_cast<std::size_t>(wanted.loops)) << "seed " << seed;
    }
    loops += wanted.loops > 0 ? 1 : 0;
    cavities += wanted.cavities > 0 ? 1 : 0;
  }
  EXPECT_GT(loops, 10u);
  EXPECT_GT(cavities, 2u);
}

TEST(CurveSkeleton, IsTheSameForEveryScaleAndNumberOfThreads) {
  const Surface solid(test::l_shape());
  const MedialMesh axis = axis_of(solid, 1000);
  const CurveSkeleton skeleton = curve_skeleton(solid, axis);
  MedialMesh larger = axis;
  for (Point& center : larger.centers) center *= 2;
  for (double& radius : larger.radii) radius *= 2;
  const CurveSkeleton scaled = curve_skeleton(Surface(test::transformed(test::l_shape(), 2, Vector::Zero())), larger);
  ASSERT_EQ(scaled.edges, skeleton.edges);
  for (std::size_t i = 0; i < skeleton.vertices.size(); ++i) {
    EXPECT_EQ(scaled.vertices[i], 2 * skeleton.vertices[i]);
    EXPECT_EQ(scaled.radii[i], 2 * skeleton.radii[i]);
  }
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(to_csv(curve_skeleton(solid, axis)), to_csv(skeleton));
}

TEST(CurveSkeleton, IsAForestInSwcWhichSaysWhereLoopsWereCut) {
  const test::KnownAxis torus = test::known_torus(96, 32);
  const CurveSkeleton skeleton = curve_skeleton(Surface(torus.solid), torus.axis);
  EXPECT_EQ(left_out_of_swc(skeleton).size(), 1u);
  const std::string swc = to_swc(skeleton);
  EXPECT_NE(swc.find("# left out: "), std::string::npos);
  EXPECT_EQ(static_cast<std::size_t>(std::count(swc.begin(), swc.end(), '\n')), skeleton.vertices.size() + 2);
}

TEST(BurnTimes, OfABoxAreTheWaysToItsEdges) {
  const test::KnownAxis box = test::known_box({1, 2, 4});
  const double diagonal = std::sqrt(21.0);
  MedialMesh axis = box.axis;
  const std::vector<double> times = burn_times(axis, diagonal);
  ASSERT_EQ(times.size(), axis.centers.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double radius = axis.radii[i];  // at its corners, and at those of the middle rectangle
    EXPECT_NEAR(times[i], radius == 0 ? 0 : std::sqrt(2.0) * radius, 0.02 * diagonal) << i;
    EXPECT_GE(times[i], radius);
  }
}

TEST(CurveSkeleton, RefusesOptionsOutOfRange) {
  const test::KnownAxis ball = test::known_sphere(1);
  const Surface solid(ball.solid);
  EXPECT_THROW(curve_skeleton(solid, ball.axis, {.erosion = -1}), InputError);
  EXPECT_THROW(curve_skeleton(solid, ball.axis, {.ratio = 0.1}), InputError);
  EXPECT_THROW(curve_skeleton(solid, ball.axis, {.ratio = 1}), InputError);
  EXPECT_THROW(curve_skeleton(solid, ball.axis, {.edge_length = 0}), InputError);
  EXPECT_THROW(curve_skeleton(solid, ball.axis, {.smoothing = -1}), InputError);
  EXPECT_THROW(curve_skeleton(solid, MedialMesh{}), InputError);
  EXPECT_THROW(burn_times(ball.axis, 0), InputError);
}

}  // namespace
}  // namespace orchard
