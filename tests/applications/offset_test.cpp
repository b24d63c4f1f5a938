// Offsets of solids that have them in closed form.
#include "orchard/medial/offset.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_check.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// Of a box or prism grown by d, by Steiner: area, half the sum of edges times their exterior angles.
double grown(double volume, double area, double edges, double d) {
  return volume + area * d + edges * d * d + 4 * std::numbers::pi / 3 * d * d * d;
}

double brute_distance(const TriangleMesh& mesh, const Point& place) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    least = std::min(least,
                     closest_point_of_triangle(place, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]).distance);
  return least;
}

// Distances to all input triangles at many places of the result must be within its bounds, and come near to them.
void check_bounds(const OffsetMesh& offset, const TriangleMesh& input, std::size_t stride) {
  constexpr int kParts = 4;
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t t = 0; t < offset.mesh.triangles.size(); t += stride) {
    const auto& [a, b, c] = offset.mesh.triangles[t];
    for (int i = 0; i <= kParts; ++i)
      for (int k = 0; i + k <= kParts; ++k) {
        const Point place =
            (offset.mesh.vertices[a] * i + offset.mesh.vertices[b] * k + offset.mesh.vertices[c] * (kParts - i - k)) /
            kParts;
        const double distance = brute_distance(input, place);
        least = std::min(least, distance);
        most = std::max(most, distance);
      }
  }
  EXPECT_GE(least, offset.min_distance);
  EXPECT_LE(most, offset.max_distance);
  EXPECT_LE(brute_distance(input, offset.nearest) - offset.min_distance, 0.03 * offset.tolerance);
  EXPECT_LE(offset.max_distance - brute_distance(input, offset.farthest), 0.03 * offset.tolerance);
}

// The result lies between the offsets that are a tolerance less and more: so does its volume.
void check_offset(const TriangleMesh& input, const OffsetOptions& options, std::size_t stride,
                  const std::function<double(double)>& volume) {
  const OffsetMesh offset = offset_mesh(Surface(input), options);
  const MeshReport report = check_mesh(offset.mesh);
  EXPECT_TRUE(report.solid()) << report.faults();
  EXPECT_TRUE(Surface(offset.mesh).self_intersections().empty());
  EXPECT_LE(offset.error(), offset.tolerance);
  check_bounds(offset, input, stride);
  const double less = volume(options.distance - offset.tolerance), more = volume(options.distance + offset.tolerance);
  EXPECT_GE(report.volume, std::min(less, more));
  EXPECT_LE(report.volume, std::max(less, more));
}

// A square plate from -2 to 2 with a square hole from -1 to 1, between 0 and 1.
TriangleMesh plate_with_hole() {
  TriangleMesh mesh;
  for (const double z : {0.0, 1.0})
    for (const double side : {2.0, 1.0})
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.vertices.emplace_back(side * x, side * y, z);
  const auto quad = [&](Index a, Index b, Index c, Index d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (Index i = 0; i < 4; ++i) {
    const Index k = (i + 1) % 4;
    quad(i + 8, k + 8, k + 12, i + 12);
    quad(i, i + 4, k + 4, k);
    quad(i, k, k + 8, i + 8);
    quad(i + 4, i + 12, k + 12, k + 4);
  }
  return mesh;
}

TEST(Offset, OfABoxIsRoundOutsideAndSharpInside) {
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(3, 2, 1));
  check_offset(box, {.distance = 0.3, .tolerance = 0.02}, 23,
               [](double d) { return grown(6, 22, std::numbers::pi * 6, d); });
  check_offset(box, {.distance = 0.2, .side = OffsetSide::inside, .tolerance = 0.02}, 23,
               [](double d) { return (3 - 2 * d) * (2 - 2 * d) * (1 - 2 * d); });
}

TEST(Offset, OfACylinder) {
  constexpr int kSides = 24;
  std::vector<std::array<double, 2>> outline;
  outline.reserve(kSides);
  for (int i = 0; i < kSides; ++i)
    outline.push_back({std::cos(2 * std::numbers::pi * i / kSides), std::sin(2 * std::numbers::pi * i / kSides)});
  std::vector<std::array<Index, 3>> caps;
  for (Index i = 1; i + 1 < kSides; ++i) caps.push_back({0, i, i + 1});
  const TriangleMesh cylinder = test::prism(outline, caps);
  const MeshReport report = check_mesh(cylinder);
  const double height = report.volume / (kSides * std::sin(2 * std::numbers::pi / kSides) / 2),
               around = 2 * kSides * std::sin(std::numbers::pi / kSides);
  check_offset(cylinder, {.distance = 0.25, .tolerance = 0.03}, 37, [&](double d) {
    return grown(report.volume, report.area, (2 * around * std::numbers::pi / 2 + height * 2 * std::numbers::pi) / 2,
                 d);
  });
}

TEST(Offset, OfABallAndATorusIsBetweenThoseOfTheRoundOnes) {
  const auto ball = [](double r) { return 4 * std::numbers::pi / 3 * r * r * r; };
  const OffsetMesh grown_ball = offset_mesh(Surface(test::icosphere(3)), {.distance = 0.5, .tolerance = 0.02});
  const double off = 0.01 + grown_ball.tolerance;  // of the facets, and of the offset
  EXPECT_GT(check_mesh(grown_ball.mesh).volume, ball(1.5 - off));
  EXPECT_LT(check_mesh(grown_ball.mesh).volume, ball(1.5 + off));
  check_bounds(grown_ball, test::icosphere(3), 401);
  const TriangleMesh ring = test::torus(64, 32);
  const OffsetMesh thin = offset_mesh(Surface(ring), {.distance = 0.15, .side = OffsetSide::inside, .tolerance = 0.02});
  const auto torus = [](double r) { return 2 * std::numbers::pi * std::numbers::pi * r * r; };
  const double tolerance = thin.tolerance + 0.01;
  EXPECT_GT(check_mesh(thin.mesh).volume, torus(0.2 - tolerance));
  EXPECT_LT(check_mesh(thin.mesh).volume, torus(0.2 + tolerance));
  EXPECT_EQ(check_mesh(thin.mesh).euler_characteristic, 0);
}

TEST(Offset, OfAPlateWithAHoleIsRoundAtItsReflexEdgesInside) {
  check_offset(plate_with_hole(), {.distance = 0.2, .side = OffsetSide::inside, .tolerance = 0.01}, 11, [](double d) {
    return (1 - 2 * d) * ((4 - 2 * d) * (4 - 2 * d) - (4 + 8 * d + std::numbers::pi * d * d));
  });
}

TEST(Offset, MakesAShellOfAnOpenSurface) {
  const TriangleMesh open = test::open_box();
  const OffsetMesh shell = offset_mesh(Surface(open), {.distance = 0.05, .side = OffsetSide::both, .tolerance = 0.02});
  EXPECT_TRUE(check_mesh(shell.mesh).solid());
  EXPECT_EQ(check_mesh(shell.mesh).components, 1u);
  EXPECT_LE(shell.cell, 0.025);
  EXPECT_GT(shell.min_distance, 0);
  check_bounds(shell, open, 13);
  EXPECT_THROW(offset_mesh(Surface(open), {.distance = 0.05}), InputError);
}

TEST(Offset, HollowsWithWallsThatAreProven) {
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(3, 2, 1));
  const HollowMesh hollow = hollow_mesh(Surface(box), 0.2, {.tolerance = 0.01});
  EXPECT_TRUE(check_mesh(hollow.mesh).solid());
  EXPECT_GE(hollow.min_wall, 0.2);
  EXPECT_LE(hollow.min_wall, 0.2 + 0.1 * hollow.cavity.tolerance);  // no thicker than is proven to be needed
  EXPECT_LE(hollow.cavity.max_distance, 0.2 + 1.6 * hollow.cavity.tolerance);
  const double thickest = 0.2 + 1.6 * hollow.cavity.tolerance;
  EXPECT_GE(check_mesh(hollow.mesh).volume, 6 - 2.6 * 1.6 * 0.6);
  EXPECT_LE(check_mesh(hollow.mesh).volume, 6 - (3 - 2 * thickest) * (2 - 2 * thickest) * (1 - 2 * thickest));
  // Arms of a U thinner than two walls stay solid.
  EXPECT_THROW(hollow_mesh(Surface(box), 0.5, {.tolerance = 0.01}), InputError);
}

TEST(Offset, IsTheSameOnAnyNumberOfThreads) {
  const Surface surface(test::l_shape());
  const OffsetOptions options{.distance = 0.1, .tolerance = 0.03};
  const OffsetMesh many = offset_mesh(surface, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const OffsetMesh alone = offset_mesh(surface, options);
  EXPECT_EQ(many.mesh.triangles, alone.mesh.triangles);
  EXPECT_EQ(many.min_distance, alone.min_distance);
  EXPECT_EQ(many.max_distance, alone.max_distance);
}

TEST(Offset, RefusesWhatCannotBe) {
  const Surface box(test::box(Point(0, 0, 0), Point(1, 1, 1)));
  for (const double distance : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(offset_mesh(box, {.distance = distance}), InputError) << distance;
  for (const double tolerance : {0.0, 1e-5, 0.7})
    EXPECT_THROW(offset_mesh(box, {.distance = 1, .tolerance = tolerance}), InputError) << tolerance;
  EXPECT_THROW(offset_mesh(box, {.distance = 0.6, .side = OffsetSide::inside}), InputError);
  EXPECT_THROW(offset_mesh(box, {.distance = 1e-6, .side = OffsetSide::both}), InputError);  // too many cells
}

}  // namespace
}  // namespace orchard
