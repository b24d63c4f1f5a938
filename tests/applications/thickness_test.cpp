// The local thickness of solids that have it in closed form.
#include "orchard/medial/thickness.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orchard/geometry/error.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kPi = std::numbers::pi, kExact = 1e-9;

double degrees(double angle) { return angle * kPi / 180; }

Point middle(const LocalThickness& thickness, Index triangle) {
  const auto& [a, b, c] = thickness.mesh.triangles[triangle];
  const auto& vertices = thickness.mesh.vertices;
  return (vertices[a] + vertices[b] + vertices[c]) / 3;
}

// A ring of straight pieces with a regular cross-section, mitred where they meet, so that all facets are flat. Pieces
// are centred around the angles (i + 1/2) 2 pi / around.
TriangleMesh mitred_ring(int around, int across, double major_radius, double minor_radius) {
  TriangleMesh mesh = test::torus(around, across, major_radius, minor_radius);
  for (Point& vertex : mesh.vertices) vertex.head<2>() /= std::cos(kPi / around);
  return mesh;
}

// A square plate from -2 to 2 with a square hole from -1 to 1, between 0 and `height`.
TriangleMesh plate_with_hole(double height) {
  TriangleMesh mesh;
  for (const double z : {0.0, height}) {
    for (const double side : {2.0, 1.0}) {
      for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}})
        mesh.vertices.emplace_back(side * x, side * y, z);
    }
  }
  for (Index i = 0; i < 4; ++i) {
    const Index k = (i + 1) % 4;
    const auto quad = [&](Index a, Index b, Index c, Index d) {
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    };
    quad(i + 8, k + 8, k + 12, i + 12);  // top
    quad(i, i + 4, k + 4, k);            // bottom
    quad(i, k, k + 8, i + 8);            // outer walls
    quad(i + 4, i + 12, k + 12, k + 4);  // walls of the hole
  }
  return mesh;
}

double distance_to_side(double x, double y) {
  const double rim = std::min(2 - std::abs(x), 2 - std::abs(y));
  const double hole = std::hypot(std::max(std::abs(x) - 1, 0.0), std::max(std::abs(y) - 1, 0.0));
  return std::min(rim, hole);
}

TEST(Thickness, OfABoxIsTheWayToItsOtherSideOrTwiceThatToTheNearestEdge) {
  const Surface surface(test::box(Point(0, 0, 0), Point(2, 3, 1)));
  const LocalThickness found = local_thickness(surface, {.samples = 2000});
  ASSERT_GE(found.mesh.triangles.size(), 1000u);
  const Vector size(2, 3, 1);
  for (Index i = 0; i < found.mesh.triangles.size(); ++i) {
    const Point at = middle(found, i);
    double to_edge = 10;
    Eigen::Index axis = 0;
    surface.normal(found.of_triangle[i]).cwiseAbs().maxCoeff(&axis);
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (k != axis) to_edge = std::min({to_edge, at[k], size[k] - at[k]});
    }
    const double expected = std::min(size[axis], 2 * to_edge);
    EXPECT_NEAR(found.at_triangles.ball_diameter[i], expected, kExact);
    EXPECT_EQ(found.at_triangles.error[i], 0);
    if (2 * to_edge > size[axis] - kExact) {
      EXPECT_NEAR(found.at_triangles.thickness[i], expected, kExact);
      EXPECT_NEAR(found.at_triangles.contact_angle[i], kPi, 1e-6);
    } else if (2 * to_edge < size[axis] - kExact) {
      EXPECT_TRUE(std::isnan(found.at_triangles.thickness[i]));
    }
  }
}

TEST(Thickness, IsZeroAndNotDefinedOnEdgesThatStickOut) {
  const LocalThickness found = local_thickness(Surface(test::box(Point(0, 0, 0), Point(1, 1, 1))), {.samples = 200});
  Index on_edges = 0;
  for (Index i = 0; i < found.mesh.vertices.size(); ++i) {
    const Point& at = found.mesh.vertices[i];
    const auto extreme = (at.array() == 0 || at.array() == 1).count();
    if (extreme < 2) continue;
    ++on_edges;
    EXPECT_EQ(found.at_vertices.ball_diameter[i], 0);
    EXPECT_TRUE(std::isnan(found.at_vertices.thickness[i]));
  }
  EXPECT_GT(on_edges, 8u);
}

TEST(Thickness, OfAPolyhedronAroundABallIsTheBallsWhereItsFacetsTouchIt) {
  const Surface surface(test::icosphere(0));
  const double inner = -surface.normal(0).dot(Point::Zero() - surface.corners(0)[0]);
  std::vector<SurfacePlace> places;
  for (Index i = 0; i < 20; ++i) places.push_back({inner * surface.normal(i), i, Feature::face});
  for (const ThicknessAt& at : thickness_at(surface, places)) {
    EXPECT_NEAR(at.diameter, 2 * inner, kExact);
    EXPECT_NEAR(at.thickness, 2 * inner, kExact);
    EXPECT_GE(at.angle, degrees(120));
  }
}

TEST(Thickness, OfAFineSphereIsItsDiameterUpToItsFacets) {
  const LocalThickness found = local_thickness(Surface(test::icosphere(3)), {.samples = 1});
  for (const auto* values : {&found.at_vertices, &found.at_triangles}) {
    for (std::size_t i = 0; i < values->thickness.size(); ++i) {
      EXPECT_GT(values->thickness[i], 1.97);
      EXPECT_LE(values->thickness[i], 2);
    }
  }
}

TEST(Thickness, OfACylinderIsTwiceItsApothem) {
  const int sides = 24;
  const double apothem = std::cos(kPi / sides);
  const Surface surface(test::turned({{1, -4}, {1, 4}}, sides));
  std::vector<SurfacePlace> places;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / sides;
    const ClosestPoint on = surface.closest(Point(apothem * std::cos(angle), apothem * std::sin(angle), 0.3));
    places.push_back({on.position, on.triangle, on.feature});
  }
  for (const ThicknessAt& at : thickness_at(surface, places)) EXPECT_NEAR(at.diameter, 2 * apothem, kExact);
}

TEST(Thickness, IsNotDefinedBesideTheSharpRimOfAFacetedCylinder) {
  const Surface surface(test::turned({{1, -4}, {1, 4}}, 12));
  const LocalThickness found = local_thickness(surface, {.samples = 3000});
  for (Index i = 0; i < found.mesh.triangles.size(); ++i) {
    const double thickness = found.at_triangles.thickness[i];
    if (std::isnan(thickness)) continue;
    EXPECT_GT(thickness, 2 * std::cos(kPi / 12) * 0.95);
    EXPECT_LE(thickness, 8 + kExact);
  }
}

TEST(Thickness, OfAMitredRingIsThatOfItsCrossSection) {
  const int around = 8, across = 8;
  const double minor = 0.3, apothem = minor * std::cos(kPi / across);
  const Surface surface(mitred_ring(around, across, 1, minor));
  std::vector<SurfacePlace> places;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * kPi * (i + 0.5) / around;
    for (int k = 0; k < across; ++k) {
      const double v = 2 * kPi * (k + 0.5) / across, distance = 1 + apothem * std::cos(v);
      const Point at(distance * std::cos(u), distance * std::sin(u), apothem * std::sin(v));
      const ClosestPoint on = surface.closest(at);
      ASSERT_NEAR(on.distance, 0, kExact);
      places.push_back({on.position, on.triangle, on.feature});
    }
  }
  const std::vector<ThicknessAt> found = thickness_at(surface, places, {.smooth = degrees(5)});
  for (const ThicknessAt& at : found) EXPECT_NEAR(at.diameter, 2 * apothem, kExact);
}

TEST(Thickness, OfAWedgeGrowsWithTheDistanceFromItsEdge) {
  const double angle = degrees(40), length = 3;
  const Surface surface(
      test::prism({{0, 0}, {length, 0}, {length * std::cos(angle), length * std::sin(angle)}}, {{0, 1, 2}}, 20));
  std::vector<SurfacePlace> places;
  for (const double x : {0.01, 0.1, 0.5, 1.0}) {
    const ClosestPoint on = surface.closest(Point(x, 0, 10));
    places.push_back({on.position, on.triangle, on.feature});
  }
  const std::vector<ThicknessAt> found = thickness_at(surface, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    EXPECT_NEAR(found[i].diameter, 2 * places[i].position.x() * std::tan(angle / 2), kExact);
    EXPECT_NEAR(found[i].angle, kPi - angle, 1e-6);
  }
}

TEST(Thickness, OfAPlateWithAHoleIsItsHeightAwayFromItsSides) {
  const double height = 0.5;
  const Surface surface(plate_with_hole(height));
  ASSERT_TRUE(surface.solid());
  const LocalThickness found = local_thickness(surface, {.samples = 3000});
  double area = 0;
  for (Index i = 0; i < found.mesh.triangles.size(); ++i) {
    if (std::abs(surface.normal(found.of_triangle[i]).z()) < 0.5) continue;
    const Point at = middle(found, i);
    const double to_side = distance_to_side(at.x(), at.y());
    EXPECT_NEAR(found.at_triangles.ball_diameter[i], std::min(height, 2 * to_side), kExact);
    if (!std::isnan(found.at_triangles.thickness[i])) area += surface.area(found.of_triangle[i]);
  }
  EXPECT_GT(area, 0);
}

TEST(Thickness, OnAReentrantEdgeIsThatOfTheLargestBallThere) {
  // The balls at the edge x = y = 1 along the diagonal end at two walls at once, as far as (1, 1) - r (1, 1) / sqrt 2.
  TriangleMesh tall = test::l_shape();
  for (Point& vertex : tall.vertices) vertex.z() *= 10;
  const Surface high(std::move(tall));
  const ClosestPoint on = high.closest(Point(1, 1, 5));
  const std::vector<SurfacePlace> places{{on.position, on.triangle, on.feature}};
  const double radius = 1 / (1 + std::sqrt(0.5));
  EXPECT_NEAR(thickness_at(high, places)[0].diameter, 2 * radius, kExact);
}

TEST(Thickness, ByRaysIsTheWayThroughTheSolid) {
  const LocalThickness found = local_thickness(Surface(test::box(Point(0, 0, 0), Point(2, 3, 1))),
                                               {.definition = ThicknessDefinition::ray, .samples = 500});
  for (Index i = 0; i < found.mesh.triangles.size(); ++i) {
    const double way = found.at_triangles.thickness[i];
    EXPECT_TRUE(std::abs(way - 1) < kExact || std::abs(way - 2) < kExact || std::abs(way - 3) < kExact) << way;
  }
}

TEST(Thickness, OfAShellIsBetweenItsTwoSurfaces) {
  const Surface surface(test::joined({test::box(Point(-2, -2, -2), Point(2, 2, 2)),
                                      test::mirrored(test::box(Point(-1.75, -1.75, -1.75), Point(1.75, 1.75, 1.75)))}));
  ASSERT_TRUE(surface.solid());
  const ClosestPoint on = surface.closest(Point(0.1, 0.2, 2));
  EXPECT_NEAR(thickness_at(surface, std::vector<SurfacePlace>{{on.position, on.triangle, on.feature}})[0].diameter,
              0.25, kExact);
}

TEST(Thickness, ScalesExactlyWithAPowerOfTwo) {
  const TriangleMesh mesh = test::torus(20, 12);
  const LocalThickness one = local_thickness(Surface(mesh), {.samples = 1});
  const LocalThickness large = local_thickness(Surface(test::transformed(mesh, 1024, Vector::Zero())), {.samples = 1});
  for (std::size_t i = 0; i < one.at_vertices.ball_diameter.size(); ++i)
    EXPECT_EQ(1024 * one.at_vertices.ball_diameter[i], large.at_vertices.ball_diameter[i]);
}

TEST(Thickness, IsTheSameWhateverTheNumberOfThreads) {
  const Surface surface(test::torus(30, 16));
  std::vector<double> first;
  for (const std::size_t threads : {1u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const LocalThickness found = local_thickness(surface, {.samples = 4000});
    if (first.empty()) first = found.at_triangles.ball_diameter;
    EXPECT_EQ(first, found.at_triangles.ball_diameter);
  }
}

TEST(Thickness, RefusesOptionsOutOfRangeAndWhatIsNoSolid) {
  const Surface box(test::box(Point(0, 0, 0), Point(1, 1, 1)));
  EXPECT_THROW(local_thickness(box, {.facing = -1}), InputError);
  EXPECT_THROW(local_thickness(box, {.facing = std::nan("")}), InputError);
  EXPECT_THROW(local_thickness(box, {.smooth = 0}), InputError);
  EXPECT_THROW(local_thickness(box, {.samples = 0}), InputError);
  EXPECT_THROW(local_thickness(Surface(test::open_box())), InputError);
}

TEST(ThinRegions, AreBothSidesOfEachPlateThatIsThinnerThanTheLimit) {
  // Two plates of different height, and a cube that is thick everywhere.
  const Surface surface(
      test::joined({test::box(Point(0, 0, 0), Point(4, 4, 0.1)), test::box(Point(10, 0, 0), Point(13, 3, 0.2)),
                    test::box(Point(20, 0, 0), Point(22, 2, 2))}));
  const LocalThickness found = local_thickness(surface, {.samples = 5000});
  const ThinRegions thin = thin_regions(found, 0.3);
  // Both faces of each plate but for strips along their rims, where balls touch the rim.
  ASSERT_EQ(thin.regions.size(), 4u);
  EXPECT_NEAR(thin.regions[0].area, 3.9 * 3.9, 0.6);
  EXPECT_NEAR(thin.regions[0].min_thickness, 0.1, kExact);
  EXPECT_NEAR(thin.regions[3].area, 2.8 * 2.8, 0.6);
  EXPECT_NEAR(thin.regions[3].min_thickness, 0.2, kExact);
  EXPECT_LT(thin.regions[3].box.max().x(), 13.01);
  EXPECT_GE(thin.regions[0].area, thin.regions[1].area);
  EXPECT_NEAR(thin.total_area, 32 + 1.6 + 18 + 2.4 + 24, kExact);
  double sum = 0;
  for (const ThinRegion& region : thin.regions) sum += region.area;
  EXPECT_NEAR(sum, thin.area, kExact);
  EXPECT_EQ(thin_regions(found, 0.1 - kExact).regions.size(), 0u);
}

TEST(ThicknessHistogram, HoldsTheAreaOfTheSurfaceOnce) {
  const LocalThickness found = local_thickness(Surface(test::box(Point(0, 0, 0), Point(2, 3, 1))), {.samples = 1000});
  const ThicknessHistogram histogram = thickness_histogram(found, 20);
  double all = 0, defined = 0;
  for (const double area : histogram.ball_diameter) all += area;
  for (const double area : histogram.thickness) defined += area;
  EXPECT_NEAR(all, 22, kExact);
  EXPECT_NEAR(defined, thin_regions(found, 0).defined_area, kExact);
  EXPECT_NEAR(histogram.bin_width, 0.05, 1e-3);
}

}  // namespace
}  // namespace orchard
