#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "expect_input_error.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/reconstruct.h"

namespace orchard {
namespace {

namespace fs = std::filesystem;

OrientedPoints sphere_points(Index count) {
  OrientedPoints points;
  const double turn = std::acos(-1.0) * (3 - std::sqrt(5.0));
  for (Index i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, radius = std::sqrt(1 - z * z);
    points.normals.emplace_back(radius * std::cos(turn * i), radius * std::sin(turn * i), z);
    points.points.push_back(Point(3, 2, 1) + 2 * points.normals.back());
  }
  return points;
}

TEST(Reconstruction, MakesAClosedSurfaceNearThePoints) {
  const OrientedPoints points = sphere_points(1500);
  const ReconstructedMesh made = reconstruct_surface(points);
  EXPECT_TRUE(check_mesh(made.mesh).solid());
  EXPECT_NEAR(check_mesh(made.mesh).volume, 4. / 3 * std::acos(-1.0) * 8, 1);
  EXPECT_LT(made.max_from_points, made.spacing);
  EXPECT_LE(made.mean_from_points, made.max_from_points);
  EXPECT_LT(made.to_points.upper, 2 * made.spacing);
  // The bound holds at the vertices and in the middles of the triangles.
  for (const auto& [a, b, c] : made.mesh.triangles) {
    const Point middle = (made.mesh.vertices[a] + made.mesh.vertices[b] + made.mesh.vertices[c]) / 3;
    double nearest = 1e9;
    for (const Point& point : points.points) nearest = std::min(nearest, (point - middle).norm());
    ASSERT_LE(nearest, made.to_points.upper);
  }
}

TEST(Reconstruction, RefusesWhatIsNoSurface) {
  test::expect_input_error([&] { reconstruct_surface(sphere_points(10)); }, {"needs 16"});
  OrientedPoints one_place = sphere_points(100);
  for (Point& point : one_place.points) point = Point(1, 1, 1);
  test::expect_input_error([&] { reconstruct_surface(one_place); }, {"one place"});
}

TEST(OrientedPoints, AreReadFromTextAndPly) {
  const fs::path xyz = fs::path(testing::TempDir()) / "orchard-points.xyz",
                 ply = fs::path(xyz).replace_extension("ply");
  std::ofstream(xyz) << "x y z nx ny nz\n# a comment\n0 0 1, 0 0 2\n1;0;0;1;0;0\n";
  const auto points = read_oriented_points(xyz);
  ASSERT_TRUE(points);
  ASSERT_EQ(points->points.size(), 2u);
  EXPECT_EQ(points->normals[0], Vector(0, 0, 1));
  std::ofstream(ply)
      << "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
         "property float nx\nproperty float ny\nproperty float nz\nend_header\n1 2 3 0 -1 0\n";
  ASSERT_TRUE(read_oriented_points(ply));
  EXPECT_EQ(read_oriented_points(ply)->normals[0], Vector(0, -1, 0));
  EXPECT_FALSE(read_oriented_points("a.stl"));
  fs::remove(xyz);
  fs::remove(ply);
}

TEST(OrientedPoints, NeedANormalAtEachPoint) {
  const fs::path xyz = fs::path(testing::TempDir()) / "orchard-points.xyz";
  std::ofstream(xyz) << "0 0 1 0 0 1\n1 0 0\n";
  test::expect_input_error([&] { read_oriented_points(xyz); }, {"line 2: points without normals"});
  std::ofstream(xyz) << "0 0 1 0 0 1\n1 0 0 0 0 0\n";
  test::expect_input_error([&] { read_oriented_points(xyz); }, {"line 2: the normal is zero"});
  fs::remove(xyz);
}

}  // namespace
}  // namespace orchard
