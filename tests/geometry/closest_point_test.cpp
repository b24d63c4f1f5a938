#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "surface_queries.h"

namespace orchard {
namespace {

using test::all_meshes;
using test::closest_by_brute_force;
using test::queries_for;
using test::winding_number;

TEST(ClosestPointOfTriangle, IsNearerThanEveryOtherPointOfTheTriangle) {
  for (std::uint64_t seed = 0; seed < 20000; ++seed) {
    Random random(seed, 3);
    const auto in_cube = [&] { return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    std::array<Point, 3> p{in_cube(), in_cube(), in_cube()};
    // Every other triangle is a needle, down to the rounding of its width.
    if (seed % 2 == 0)
      p[2] = p[0] + random.uniform() * (p[1] - p[0]) + std::pow(10, random.uniform(-17, 0)) * in_cube();
    if (seed % 3 == 0) std::swap(p[0], p[2]);
    const Point query = std::pow(10, random.uniform(-10, 2)) * in_cube() + p[seed % 3];
    const ClosestPoint closest = closest_point_of_triangle(query, p[0], p[1], p[2]);
    const Vector back = query - closest.position;
    // The triangle lies behind the plane through the closest point, perpendicular to the way to the query.
    const double rounding = 1e-14 * (1 + back.norm());
    for (const Point& corner : p)
      ASSERT_LE(back.dot(corner - closest.position), rounding * (1 + back.norm())) << "seed " << seed;
    ASSERT_NEAR(closest.distance, back.norm(), rounding) << "seed " << seed;
  }
}

TEST(ClosestPointOfTriangle, NamesTheFeatureThatTheClosestPointLiesOn) {
  const Point a(0, 0, 0), b(4, 0, 0), c(0, 4, 0);
  const std::vector<std::pair<Point, Feature>> cases = {
      {{1, 1, 5}, Feature::face},      {{1, 1, 0}, Feature::face},     {{1, -1, 2}, Feature::edge0},
      {{3, 3, 0}, Feature::edge1},     {{-1, 2, -1}, Feature::edge2},  {{1, 0, 0}, Feature::edge0},
      {{2, 2, 0}, Feature::edge1},     {{0, 3, 0}, Feature::edge2},    {{1, 0, 9}, Feature::edge0},
      {{-1, -1, 3}, Feature::vertex0}, {{6, -1, 0}, Feature::vertex1}, {{-1, 5, 0}, Feature::vertex2},
      {{0, 0, 0}, Feature::vertex0},   {{4, 0, 0}, Feature::vertex1},  {{0, 4, 1}, Feature::vertex2}};
  for (const auto& [query, feature] : cases) {
    const ClosestPoint closest = closest_point_of_triangle(query, a, b, c);
    EXPECT_EQ(closest.feature, feature) << query.transpose();
  }
}

TEST(ClosestPointOfTriangle, GivesTheSameBitsFromBothSidesOfAnEdge) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Random random(seed, 4);
    const auto in_cube = [&] { return Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    const Point a = in_cube(), b = in_cube(), c = in_cube(), d = in_cube(), query = 2 * in_cube();
    const ClosestPoint one = closest_point_of_triangle(query, a, b, c),
                       other = closest_point_of_triangle(query, b, a, d);
    if (one.feature == Feature::edge0 && other.feature == Feature::edge0) {
      ASSERT_EQ(one.distance, other.distance) << "seed " << seed;
      ASSERT_EQ(one.position, other.position) << "seed " << seed;
    }
  }
}

TEST(Surface, FindsTheSameClosestPointAsALoopOverAllTriangles) {
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    for (const Point& query : queries_for(surface, 240, 5)) {
      const ClosestPoint expected = closest_by_brute_force(surface, query), found = surface.closest(query);
      ASSERT_EQ(found.distance, expected.distance) << name << " at " << query.transpose();
      ASSERT_EQ(found.triangle, expected.triangle) << name << " at " << query.transpose();
      ASSERT_EQ(found.feature, expected.feature) << name << " at " << query.transpose();
      ASSERT_EQ(found.position, expected.position) << name << " at " << query.transpose();
    }
  }
}

// Bounds of large trees have one term more. Places deep inside are nearly as far from many triangles.
TEST(Surface, FindsTheSameClosestPointOnAFineMesh) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 2 * test::more(); ++seed) {
    Random random(seed, 5);
    TriangleMesh mesh = test::torus(256, 130);
    const double noise = seed % 2 == 0 ? 0 : 1e-3;
    for (Point& vertex : mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) vertex[axis] += noise * random.uniform(-1, 1);
    }
    const Surface surface(mesh);
    const Box& box = surface.bounding_box();
    for (int i = 0; i < 20; ++i) {
      Point query;
      for (int axis = 0; axis < 3; ++axis) query[axis] = random.uniform(box.min()[axis], box.max()[axis]);
      const ClosestPoint expected = closest_by_brute_force(surface, query), found = surface.closest(query);
      EXPECT_EQ(found.distance, expected.distance);
      EXPECT_EQ(found.position, expected.position);
      EXPECT_EQ(found.triangle, expected.triangle);
    }
  }
}

TEST(Surface, FindsTheClosestPointWithinADistanceOrNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    for (const Point& query : queries_for(surface, 120, 9)) {
      const ClosestPoint expected = surface.closest(query);
      const double exact = expected.distance;
      for (const double within : {exact, std::nextafter(exact, 2 * exact + 1), 2 * exact, 1e300}) {
        const ClosestPoint found = surface.closest_within(query, within);
        ASSERT_EQ(found.distance, exact) << name << " at " << query.transpose();
        ASSERT_EQ(found.triangle, expected.triangle) << name << " at " << query.transpose();
        ASSERT_EQ(found.position, expected.position) << name << " at " << query.transpose();
      }
      for (const double within : {std::nextafter(exact, -1.0), 0.5 * exact - 1e-300, -1.0, nan}) {
        const ClosestPoint none = surface.closest_within(query, within);
        ASSERT_EQ(none.triangle, kNone) << name << " at " << query.transpose();
        ASSERT_EQ(none.distance, std::numeric_limits<double>::infinity());
      }
    }
    EXPECT_EQ(surface.closest_within({nan, 0, 0}, 1e300).triangle, kNone);
  }
}

TEST(Surface, BreaksTiesByTheLowestTriangle) {
  const Surface surface(test::icosphere(3));  // its centre is about as far from every triangle
  const Point center = Point::Zero();
  EXPECT_EQ(surface.closest(center).triangle, closest_by_brute_force(surface, center).triangle);
  TriangleMesh twice = test::box({0, 0, 0}, {1, 1, 1});
  const auto triangles = twice.triangles;
  twice.triangles.insert(twice.triangles.end(), triangles.begin(), triangles.end());
  EXPECT_LT(Surface(twice).closest({0.3, 0.4, 2}).triangle, triangles.size());
}

TEST(Surface, FindsExactlyTheTrianglesThatTouchAClosedBall) {
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    std::vector<Index> found;
    std::uint64_t item = 0;
    for (const Point& query : queries_for(surface, 60, 6)) {
      Random random(6, 7, item++);
      const auto [a, b, c] = surface.corners(static_cast<Index>(random.below(mesh.triangles.size())));
      const double exact = closest_point_of_triangle(query, a, b, c).distance;
      for (const double radius :
           {0.0, exact, std::nextafter(exact, 0.0), random.uniform() * surface.bounding_radius()}) {
        std::vector<Index> expected;
        for (Index t = 0; t < mesh.triangles.size(); ++t) {
          const auto [p, q, r] = surface.corners(t);
          if (closest_point_of_triangle(query, p, q, r).distance <= radius) expected.push_back(t);
        }
        surface.triangles_near({query, radius}, found);
        ASSERT_EQ(found, expected) << name << " at " << query.transpose() << ", radius " << radius;
      }
    }
  }
}

TEST(Surface, MeasuresRealModelsLikeABruteForceLoop) {
  const std::filesystem::path shared = ORCHARD_SHARED_MODELS, bundled = ORCHARD_DATA_DIR;
  for (const auto& file : {bundled / "lamp.obj", bundled / "faucet.obj", bundled / "ship.obj",
                           shared / "clean/spot.obj", shared / "dirty/cow.obj", shared / "clean/fandisk.obj"}) {
    if (!std::filesystem::exists(file)) continue;
    const Surface surface(read_mesh(file));
    for (const Point& query : queries_for(surface, 80, 12)) {
      const ClosestPoint expected = closest_by_brute_force(surface, query), found = surface.closest(query);
      ASSERT_EQ(found.distance, expected.distance) << file << " at " << query.transpose();
      ASSERT_EQ(found.triangle, expected.triangle) << file << " at " << query.transpose();
      if (!surface.solid() || found.distance < 1e-10 * surface.bounding_radius()) continue;
      ASSERT_EQ(surface.inside(query), winding_number(surface, query) > 0.5) << file << " at " << query.transpose();
    }
  }
}

}  // namespace
}  // namespace orchard
