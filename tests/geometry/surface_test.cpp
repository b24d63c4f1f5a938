#include "orchard/geometry/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>
#include <thread>

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
};

// Needles, points, coincident and crossing triangles: legal for distances.
TriangleMesh degenerate_soup() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0},     {0, 1, 0}, {1, 1e-9, 0},       {0.5, 0.5, 0.5}, {0.25, 0.25, 0.25},
                   {2, 2, 2}, {1, 1e-16, 0}, {3, 0, 0}, {0.3, 1e-12, 1e-3}, {-1, 0.1, 7}};
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 5, 4}, {6, 6, 6}, {0, 4, 6}, {1, 2, 0},
                    {0, 1, 7}, {1, 8, 0}, {2, 2, 8}, {0, 8, 9}, {4, 9, 10}};
  return mesh;
}

TriangleMesh random_soup(std::uint64_t seed) {
  Random random(seed, 1);
  TriangleMesh mesh;
  for (int i = 0; i < 120; ++i) {
    const Point corner(random.uniform(), random.uniform(), random.uniform());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(corner + 0.2 * Vector(random.uniform(), random.uniform(), random.uniform()));
  }
  for (Index t = 0; t < 120; ++t) mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  return mesh;
}

std::vector<NamedMesh> solids() {
  return {{"box", test::box({0, 0, 0}, {1, 2, 3})}, {"l_shape", test::l_shape()},
          {"u_shape", test::u_shape(0.1)},          {"torus", test::torus(24, 12)},
          {"icosphere", test::icosphere(2)},        {"two_boxes", test::two_boxes(0.01)}};
}

std::vector<NamedMesh> all_meshes() {
  std::vector<NamedMesh> meshes = solids();
  meshes.push_back({"open_box", test::open_box()});
  meshes.push_back({"degenerate_soup", degenerate_soup()});
  meshes.push_back({"random_soup", random_soup(7)});
  meshes.push_back({"one_triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}});
  meshes.push_back({"one_point", {{{1, 2, 3}}, {{0, 0, 0}}}});
  std::vector<NamedMesh> placed;
  for (const auto& [name, mesh] : meshes) {
    placed.push_back({name, mesh});
    placed.push_back({name + " scaled by 1e-6", test::transformed(mesh, 1e-6, Vector::Zero())});
    placed.push_back({name + " scaled by 1e6", test::transformed(mesh, 1e6, Vector::Zero())});
    placed.push_back({name + " offset by 1e6", test::transformed(mesh, 1, {1e6, -1e6, 1e6})});
    placed.push_back({name + " scaled by 1e-30", test::transformed(mesh, 1e-30, Vector::Zero())});
    placed.push_back({name + " scaled by 1e30", test::transformed(mesh, 1e30, Vector::Zero())});
  }
  return placed;
}

// In and around the box, on vertices, edges and faces, at distances from a rounding to a size off them, and far away.
std::vector<Point> queries_for(const Surface& surface, int count, std::uint64_t seed) {
  const Box& box = surface.bounding_box();
  const double size = std::max(surface.bounding_radius(), 1e-40);
  std::vector<Point> queries;
  for (int i = 0; i < count; ++i) {
    Random random(seed, 2, static_cast<std::uint64_t>(i));
    const auto in_cube = [&] { return Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
    const auto [a, b, c] = surface.corners(static_cast<Index>(random.below(surface.mesh().triangles.size())));
    const double u = random.uniform(), v = random.uniform(0, 1 - u);
    const Vector normal = (b - a).cross(c - a).normalized();
    const Vector away = (std::isfinite(normal.x()) ? normal : Vector::UnitZ()) * size * std::ldexp(1.0, -(i % 60));
    switch (i % 8) {
      case 0:
        queries.push_back(box.center() + 0.6 * Vector(in_cube().cwiseProduct(box.sizes())));
        break;
      case 1:
        queries.push_back(a);
        break;
      case 2:
        queries.push_back(a + u * (b - a));
        break;
      case 3:
        queries.push_back(a + u * (b - a) + v * (c - a));
        break;
      case 4:
        queries.push_back(a + u * (b - a) + v * (c - a) + away);
        break;
      case 5:
        queries.push_back(a - away);
        break;
      case 6:
        queries.push_back(b + u * (c - b) + away);
        break;
      default:
        queries.push_back(box.center() + size * std::pow(10, random.uniform(0, 12)) * in_cube());
    }
  }
  return queries;
}

ClosestPoint closest_by_brute_force(const Surface& surface, const Point& query) {
  ClosestPoint best;
  best.distance = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    ClosestPoint candidate = closest_point_of_triangle(query, a, b, c);
    if (candidate.distance >= best.distance) continue;
    best = candidate;
    best.triangle = t;
  }
  return best;
}

double winding_number(const Surface& surface, const Point& query) {
  double sum = 0;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    auto [a, b, c] = surface.corners(t);
    a -= query, b -= query, c -= query;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (4 * std::numbers::pi);
}

double coordinate_rounding(const Surface& surface) {
  const Box& box = surface.bounding_box();
  return std::numeric_limits<double>::epsilon() * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
}

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

TEST(Surface, IsInfinitelyFarFromAQueryThatIsNotFinite) {
  const Surface surface(test::icosphere(1));
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, -infinity}) {
    const Point query(0, bad, 0);
    EXPECT_EQ(surface.distance(query), infinity);
    EXPECT_EQ(surface.signed_distance(query), infinity);
    EXPECT_FALSE(surface.inside(query));
  }
}

TEST(Surface, HasEverythingFarAwayOutside) {
  for (const auto& [name, mesh] : solids()) {
    const Surface surface(mesh);
    for (const double distance : {1e3, 1e12, 1e15, 1e18, 1e25}) {
      for (std::uint64_t i = 0; i < 200; ++i) {
        Random random(3, 5, i);
        const Vector direction(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        const Point query = surface.bounding_ball().center + distance * surface.bounding_radius() * direction;
        ASSERT_FALSE(surface.inside(query)) << name << " at " << query.transpose();
      }
    }
  }
}

TEST(Surface, SignedDistanceAgreesWithTheWindingNumber) {
  for (const auto& [name, mesh] : solids()) {
    for (const double offset : {0.0, 1e6}) {
      const Surface surface(test::transformed(mesh, 1, Vector::Constant(offset)));
      const double margin = 20 * coordinate_rounding(surface) + 1e-12;
      for (const Point& query : queries_for(surface, 800, 8)) {
        const double distance = surface.signed_distance(query);
        ASSERT_EQ(std::abs(distance), surface.distance(query));
        if (std::abs(distance) <= margin) continue;
        ASSERT_EQ(distance<0, winding_number(surface, query)> 0.5) << name << " at " << query.transpose();
      }
    }
  }
}

TEST(Surface, KnowsTheSidesOfNeedleSharpEdgesAndVertices) {
  // A flat bipyramid and a thin spike: near their edges and tips the closest face's normal alone tells nothing.
  for (const double height : {1e-3, 1e3}) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, height}, {0, 0, -height}};
    for (int i = 0; i < 5; ++i)
      mesh.vertices.emplace_back(std::cos(2 * std::numbers::pi * i / 5), std::sin(2 * std::numbers::pi * i / 5), 0);
    for (Index i = 0; i < 5; ++i) {
      const Index here = 2 + i, next = 2 + (i + 1) % 5;
      mesh.triangles.push_back({0, here, next});
      mesh.triangles.push_back({1, next, here});
    }
    const Surface surface(mesh);
    ASSERT_TRUE(surface.solid());
    for (const Point& query : queries_for(surface, 2000, 9)) {
      const double distance = surface.signed_distance(query);
      if (std::abs(distance) > 1e-12 * surface.bounding_radius()) {
        ASSERT_EQ(distance<0, winding_number(surface, query)> 0.5) << height << " at " << query.transpose();
      }
    }
  }
}

TEST(Surface, SignedDistanceIsZeroAtVertices) {
  for (const auto& [name, mesh] : solids()) {
    const Surface surface(mesh);
    for (const Point& vertex : mesh.vertices) EXPECT_EQ(surface.signed_distance(vertex), 0) << name;
  }
}

TEST(Surface, SignedDistanceOfASphereIsThatOfTheSphere) {
  const Surface surface(test::icosphere(4));
  for (const double radius : {0.2, 0.8, 1.2, 5.0}) {
    EXPECT_NEAR(surface.signed_distance(Point(0.6, 0, 0.8) * radius), radius - 1, 3e-3);
  }
}

TEST(Surface, RefusesASignedDistanceWithoutAnInside) {
  const Surface surface(test::open_box());
  EXPECT_FALSE(surface.solid());
  EXPECT_THROW((void)surface.signed_distance({0, 0, 0}), InputError);
  EXPECT_THROW((void)surface.inside({0, 0, 0}), InputError);
  EXPECT_GE(surface.distance({5, 5, 5}), 0);
}

TEST(Surface, RefusesMeshesThatAreNotValid) {
  EXPECT_THROW(Surface(TriangleMesh{}), InputError);
  EXPECT_THROW(Surface(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}), InputError);
  EXPECT_THROW(Surface(TriangleMesh{{{0, 0, std::nan("")}}, {{0, 0, 0}}}), InputError);
}

TEST(Surface, KnowsWhatIsAroundAVertexAnEdgeAndAFace) {
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    for (Index v = 0; v < mesh.vertices.size(); ++v) {
      std::vector<Index> expected;
      for (Index t = 0; t < mesh.triangles.size(); ++t)
        if (std::ranges::count(mesh.triangles[t], v) > 0) expected.push_back(t);
      const auto around = surface.triangles_around(v);
      ASSERT_EQ(std::vector<Index>(around.begin(), around.end()), expected) << name << ", vertex " << v;
    }
    std::vector<Index> at;
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      surface.triangles_at(t, Feature::face, at);
      EXPECT_EQ(at, std::vector<Index>{t}) << name;
      for (std::size_t i = 0; i < 3; ++i) {
        const Index other = surface.neighbors(t)[i];
        surface.triangles_at(t, static_cast<Feature>(1 + i), at);
        std::vector<Index> expected{t};
        if (other != kNone) expected.push_back(other);
        std::ranges::sort(expected);
        EXPECT_EQ(at, expected) << name;
        surface.triangles_at(t, static_cast<Feature>(4 + i), at);
        const auto around = surface.triangles_around(mesh.triangles[t][i]);
        EXPECT_EQ(at, std::vector<Index>(around.begin(), around.end())) << name;
      }
    }
  }
}

TEST(Surface, JoinsTrianglesOnlyAcrossEdgesOfTwo) {
  // Three triangles at the edge (0, 1), two at (1, 2).
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {2, 1, 5}};
  const Surface surface(mesh);
  EXPECT_EQ(surface.neighbors(0), (std::array<Index, 3>{kNone, 3, kNone}));
  EXPECT_EQ(surface.neighbors(3), (std::array<Index, 3>{0, kNone, kNone}));
  EXPECT_EQ(surface.neighbors(1), (std::array<Index, 3>{kNone, kNone, kNone}));
}

TEST(Surface, PseudonormalsOfABoxAreItsFacesEdgesAndDiagonals) {
  const Surface surface(test::box({-1, -1, -1}, {1, 1, 1}));
  for (Index t = 0; t < 12; ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto p = surface.corners(t);
      const Vector at_vertex = surface.pseudonormal(t, static_cast<Feature>(4 + i));
      EXPECT_LT((at_vertex - p[i].normalized()).norm(), 1e-15);
      const Vector middle = 0.5 * (p[i] + p[(i + 1) % 3]);
      EXPECT_LT((surface.pseudonormal(t, static_cast<Feature>(1 + i)) - middle.normalized()).norm(), 1e-15);
    }
    EXPECT_EQ(surface.pseudonormal(t, Feature::face), surface.normal(t));
  }
}

TEST(Surface, HasUnitNormalsExceptWhereThereIsNoArea) {
  const Surface soup(degenerate_soup());
  for (Index t = 0; t < soup.mesh().triangles.size(); ++t) {
    const double length = soup.normal(t).norm();
    if (soup.area(t) > 0) {
      EXPECT_NEAR(length, 1, 1e-15);
    } else {
      EXPECT_EQ(length, 0);
    }
  }
  EXPECT_EQ(soup.area(3), 0);
  EXPECT_EQ(soup.area(0), 0.5);
  EXPECT_NEAR(soup.area(1), 0.5e-9, 1e-24);
}

TEST(Surface, IsHeldByItsBoundingBoxAndBall) {
  for (const auto& [name, mesh] : all_meshes()) {
    const Surface surface(mesh);
    for (const Point& v : mesh.vertices) {
      EXPECT_TRUE(surface.bounding_box().contains(v)) << name;
      EXPECT_LE((v - surface.bounding_ball().center).norm(), surface.bounding_radius()) << name;
    }
  }
}

TEST(Surface, ScalesEveryAnswerExactlyByPowersOfTwo) {
  for (const auto& [name, mesh] : solids()) {
    const double scale = std::ldexp(1.0, -37);
    const Surface surface(mesh), scaled(test::transformed(mesh, scale, Vector::Zero()));
    for (const Point& query : queries_for(surface, 200, 10)) {
      const ClosestPoint one = surface.closest(query), other = scaled.closest(scale * query);
      ASSERT_EQ(other.distance, scale * one.distance) << name;
      ASSERT_EQ(other.position, scale * one.position) << name;
      ASSERT_EQ(other.triangle, one.triangle) << name;
      ASSERT_EQ(scaled.signed_distance(scale * query), scale * surface.signed_distance(query)) << name;
    }
  }
}

TEST(Surface, AnswersQueriesFromManyThreads) {
  const Surface surface(test::torus(40, 20));
  const std::vector<Point> queries = queries_for(surface, 2000, 11);
  std::vector<double> expected;
  for (const Point& query : queries) expected.push_back(surface.signed_distance(query));
  std::vector<int> wrong(4, 0);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < wrong.size(); ++k)
    threads.emplace_back([&, k] {
      for (std::size_t i = 0; i < queries.size(); ++i) wrong[k] += surface.signed_distance(queries[i]) != expected[i];
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, std::vector<int>(4, 0));
}

TEST(Surface, StaysUsableWhenMoved) {
  Surface first(test::box({0, 0, 0}, {1, 1, 1}));
  const Surface second(std::move(first));
  EXPECT_EQ(second.distance({0.5, 0.5, 2}), 1);
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
