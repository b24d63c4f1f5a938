#include "orchard/geometry/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"
#include "surface_queries.h"

namespace orchard {
namespace {

using test::all_meshes;
using test::degenerate_soup;
using test::queries_for;
using test::solids;
using test::winding_number;

double coordinate_rounding(const Surface& surface) {
  const Box& box = surface.bounding_box();
  return std::numeric_limits<double>::epsilon() * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
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

}  // namespace
}  // namespace orchard
