#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "algorithms/build.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/tolerance.h"
#include "orchard/voronoi/algorithms.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/quality.h"
#include "predicates/frame.h"
#include "voronoi/algorithms/count_allocations.h"
#include "voronoi/point_sets.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard {
namespace {

using test::quadruples;

std::span<const Point> first(const test::Points& points, std::size_t n) { return std::span(points).first(n); }
std::span<const Point> rest(const test::Points& points, std::size_t n) { return std::span(points).subspan(n); }

TEST(InsertPoints, AgreesWithARebuildWhateverMadeTheDiagram) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::Points points = seed % 2 == 0 ? test::uniform_points(200, seed) : test::bumpy_sphere_points(200, seed);
    const auto expected = quadruples(exact_voronoi(points).diagram);
    for (const VoronoiAlgorithm algorithm : {VoronoiAlgorithm::highest_first, VoronoiAlgorithm::exact}) {
      VoronoiDiagram diagram = voronoi(first(points, 150), algorithm).diagram;
      const InsertionReport report = insert_points(diagram, rest(points, 150));
      validate(diagram);
      EXPECT_EQ(diagram.points, points);
      EXPECT_EQ(quadruples(diagram), expected) << name(algorithm) << ", seed " << seed;
      EXPECT_EQ(report.certified_insertions + report.settled_insertions + report.exact_insertions +
                    report.constrained_insertions,
                50u);
    }
  }
}

TEST(InsertPoints, MayBeCalledAgainAndAgain) {
  const test::Points points = test::torus_points(300, 1);
  VoronoiDiagram diagram = highest_first_voronoi(first(points, 100)).diagram;
  for (std::size_t i = 100; i < points.size(); i += 4) insert_points(diagram, std::span(points).subspan(i, 4));
  validate(diagram);
  EXPECT_EQ(quadruples(diagram), quadruples(exact_voronoi(points).diagram));
  const auto before = quadruples(diagram);
  insert_points(diagram, {});
  EXPECT_EQ(quadruples(diagram), before);
}

TEST(InsertPoints, GivesPositionsAsGoodAsARebuild) {
  const test::Points points = test::bumpy_sphere_points(400, 2);
  VoronoiDiagram diagram = highest_first_voronoi(first(points, 300)).diagram;
  insert_points(diagram, rest(points, 300));
  for (const VoronoiVertex& vertex : diagram.vertices) {
    if (vertex.at_infinity()) {
      EXPECT_NEAR(vertex.center.norm(), 1, 1e-12);
      EXPECT_EQ(vertex.radius, std::numeric_limits<double>::infinity());
      continue;
    }
    for (const Index p : vertex.forming_points)
      EXPECT_NEAR((points[p] - vertex.center).norm(), vertex.radius, 1e-9 * (1 + vertex.radius));
  }
}

TEST(InsertPoints, IsConsistentAndAccurateOnDegeneratePoints) {
  for (const auto& [name, points] : test::degenerate_point_sets())
    for (const std::size_t part : {points.size() / 2, points.size() - 1}) {
      VoronoiDiagram diagram = highest_first_voronoi(first(points, part)).diagram;
      ASSERT_NO_THROW(insert_points(diagram, rest(points, part))) << name;
      EXPECT_NO_THROW(validate(diagram)) << name;
      EXPECT_EQ(diagram.points, points);
      EXPECT_LT(inaccuracy(diagram).mean, 1e-9 * test::bounding_radius(points)) << name;
    }
}

TEST(InsertPoints, LooksAtTheNewPointsOnlyAndMendsWhereSignsContradict) {
  const test::Points cone = test::turned(test::cone_ring_points(60, 80), 1);
  test::Points points;
  for (const bool late : {false, true})
    for (std::size_t i = 0; i < cone.size(); ++i)
      if ((i % 25 == 7) == late) points.push_back(cone[i]);
  const std::size_t part = points.size() - cone.size() / 25;
  VoronoiDiagram diagram = highest_first_voronoi(first(points, part)).diagram;
  const InsertionReport report = insert_points(diagram, rest(points, part));
  validate(diagram);
  EXPECT_FALSE(report.exact_signs) << "all rebuilt for the sake of a few";
  EXPECT_LT(report.certified_intrusion, tolerance::kVoronoiIntrusion * static_cast<double>(points.size()) / 512);
  EXPECT_EQ(
      report.certified_insertions + report.settled_insertions + report.exact_insertions + report.constrained_insertions,
      points.size() - part);
  EXPECT_LT(inaccuracy(diagram).max, tolerance::kVoronoiIntrusion * test::bounding_radius(points));
}

// Flat tetrahedra at the hull have spheres so large that rounding moves their powers by more than the points' box.
TEST(InsertPoints, HoldsNoSignForCertainBeforeAVertexIsSettled) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const test::Points points = test::turned(test::box_face_points(600, seed), seed);
    const VoronoiDiagram diagram = detail::build_voronoi(points, detail::Search::highest_first, "", {}, true).diagram;
    const Box box = detail::checked_box(points);
    const detail::Frame frame(box);
    double largest = 0;
    for (const Point& query : test::turned(test::uniform_points(8, seed), seed)) {
      detail::Workspace workspace;
      set_scale(workspace, frame, box);
      for (const Point& p : points) workspace.points.push_back(frame.inward(p));
      workspace.adopt(diagram.vertices, frame, 0);
      workspace.set_exact(true);
      workspace.forget_noise();
      const Point q = frame.inward(query);
      for (Index v = 0; v < workspace.vertices.size(); ++v) {
        if (workspace.at_infinity(v)) continue;
        largest = std::max(largest, workspace.vertices[v].radius);
        const auto corner = [&](unsigned i) -> const Point& {
          return workspace.points[workspace.vertices[v].forming_points[i]];
        };
        ASSERT_EQ(workspace.sign(v, q), detail::inside_sphere(q, corner(0), corner(1), corner(2), corner(3)))
            << "vertex " << v << ", seed " << seed;
      }
    }
    EXPECT_GT(largest, 1e30);
  }
}

TEST(InsertPoints, LeavesOutWhatIsThereAlready) {
  const test::Points points = test::uniform_points(100, 3);
  VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  const auto before = quadruples(diagram);
  const InsertionReport report =
      insert_points(diagram, test::Points{points[5], points[9], points[5] + Vector(1e-9, 0, 0)});
  validate(diagram);
  EXPECT_EQ(quadruples(diagram), before);
  EXPECT_EQ(report.duplicates, (std::vector<std::array<Index, 2>>{{100, 5}, {101, 9}, {102, 5}}));
}

TEST(InsertPoints, TakesPointsFarOutsideTheDiagram) {
  test::Points points = test::uniform_points(100, 4);
  VoronoiDiagram diagram = highest_first_voronoi(points).diagram;
  const test::Points far{{100, 0, 0}, {0, -100, 3}, {-50, 60, 70}, {0.5, 0.5, 1e4}};
  insert_points(diagram, far);
  points.insert(points.end(), far.begin(), far.end());
  validate(diagram);
  EXPECT_EQ(quadruples(diagram), quadruples(exact_voronoi(points).diagram));
}

// The cell of the last point has faces with nearly all others: whichever way its new vertices are joined, by tables for
// few and for some corners, or by lists.
TEST(InsertPoints, JoinsTheNewVerticesOfAPointWithHundredsOfNeighbours) {
  for (const Index around : {50u, 200u, 700u}) {
    test::Points points = test::sphere_points(around, 9);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] *= 1 + 1e-4 * std::sin(static_cast<double>(i));
    points.emplace_back(0.01, 0.02, 0.03);
    VoronoiDiagram diagram = highest_first_voronoi(first(points, around)).diagram;
    insert_points(diagram, rest(points, around));
    validate(diagram);
    EXPECT_EQ(quadruples(diagram), quadruples(exact_voronoi(points).diagram));
    EXPECT_GT(vertices_of_points(diagram)[around].size(), 2 * around - around / 10);
  }
}

TEST(InsertPoints, MakesADiagramOfFlatPoints) {
  VoronoiDiagram diagram = highest_first_voronoi(test::Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).diagram;
  insert_points(diagram, test::Points{{1, 1, 0}});
  EXPECT_TRUE(diagram.vertices.empty());
  const InsertionReport report = insert_points(diagram, test::Points{{0.2, 0.3, 1}});
  validate(diagram);
  EXPECT_EQ(diagram.points.size(), 5u);
  EXPECT_EQ(report.dimension, 3);
  EXPECT_EQ(diagram.vertices.size(), exact_voronoi(diagram.points).diagram.vertices.size());
}

TEST(InsertPoints, LeavesTheDiagramAsItWasWhenMemoryRunsOut) {
  const test::Points points = test::turned(test::grid_points(5), 1);
  VoronoiDiagram diagram = highest_first_voronoi(first(points, 80)).diagram;
  const VoronoiDiagram before = diagram;
  std::size_t failures = 0;
  for (bool failed = true; failed; ++failures) {
    test::fail_allocation(failures);
    try {
      insert_points(diagram, rest(points, 80));
      failed = false;
    } catch (const std::bad_alloc&) {
      ASSERT_EQ(diagram.points, before.points);
      ASSERT_EQ(quadruples(diagram), quadruples(before));
    }
    test::fail_allocation(test::kNever);
  }
  EXPECT_GT(failures, 10u);
  EXPECT_EQ(diagram.points, points);
  validate(diagram);
}

TEST(InsertPoints, LeavesTheDiagramAsItWasOnBadInput) {
  VoronoiDiagram diagram = highest_first_voronoi(test::uniform_points(50, 5)).diagram;
  const VoronoiDiagram before = diagram;
  EXPECT_THROW(insert_points(diagram, test::Points{{0, 0, std::numeric_limits<double>::infinity()}}), InputError);
  EXPECT_EQ(diagram.points, before.points);
  EXPECT_EQ(quadruples(diagram), quadruples(before));
}

}  // namespace
}  // namespace orchard
