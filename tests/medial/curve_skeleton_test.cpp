// Curve skeletons of axes and solids with flat sides that have them in closed form, and of random complexes.
#include "orchard/medial/curve_skeleton.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "skeletons.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

TEST(CurveSkeleton, OfABoxIsTheRidgeOfItsMiddleRectangle) {
  const test::KnownAxis box = test::known_box({1, 2, 4});
  const CurveSkeleton skeleton = curve_skeleton(Surface(box.solid), box.axis);
  ASSERT_EQ(skeleton.arcs.size(), 1u);
  EXPECT_EQ(skeleton.nodes.size(), 2u);
  EXPECT_NEAR(skeleton.arcs[0].length, 2, 3 * skeleton.edge_length);
  for (const Point& vertex : skeleton.vertices)
    EXPECT_LT(test::distance_to_segment(vertex, Point(0.5, 1, 1), Point(0.5, 1, 3)), 1.5 * skeleton.edge_length);
  for (std::size_t i = 0; i < skeleton.vertices.size(); ++i) EXPECT_NEAR(skeleton.radii[i], 0.5, 1e-9);
  EXPECT_LT(skeleton.axis_distance, 0.05 * skeleton.edge_length);
  EXPECT_LE(skeleton.max_moved, 2 * skeleton.edge_length);
}

TEST(CurveSkeleton, HasABranchIntoEachCornerOfATriangleBelowItsRatio) {
  // The ratio of a corner of 60 degrees is 0.5.
  const Surface solid(test::prism({{{0, 0}, {4, 0}, {2, 2 * std::sqrt(3.0)}}}, {{{0, 1, 2}}}, 0.4));
  const MedialMesh axis = test::refined_axis(solid);
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

TEST(CurveSkeleton, KeepsAClosedSheetAroundACavity) {
  const TriangleMesh shell = test::joined({test::icosphere(3, 1), test::mirrored(test::icosphere(3, 0.6))});
  const Surface solid(shell);
  ASSERT_TRUE(solid.solid());
  const MedialMesh axis = test::refined_axis(solid);
  ASSERT_EQ(topology(axis), solid_topology(solid));
  const CurveSkeleton skeleton = curve_skeleton(solid, axis);
  EXPECT_FALSE(skeleton.sheets.empty());
  EXPECT_TRUE(skeleton.arcs.empty());
  EXPECT_EQ(test::topology_of(skeleton), solid_topology(solid));
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
    EXPECT_EQ(test::topology_of(skeleton), wanted) << "seed " << seed;
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
  const MedialMesh axis = test::refined_axis(solid, 1000);
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
