#include "orchard/voronoi/algorithms.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "algorithms/build.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/sampling.h"
#include "orchard/voronoi/bowyer.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/highest_first.h"
#include "orchard/voronoi/inagaki.h"
#include "orchard/voronoi/quality.h"
#include "voronoi/point_sets.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard {
namespace {

using test::quadruples;

TEST(VoronoiAlgorithms, HaveNames) {
  for (const VoronoiAlgorithm algorithm : kVoronoiAlgorithms)
    EXPECT_EQ(voronoi_algorithm_named(name(algorithm)), algorithm);
  EXPECT_EQ(voronoi_algorithm_named("highest"), std::nullopt);
}

TEST(VoronoiAlgorithms, AgreeOnPointsThatAreFarFromDegenerate) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::Points points = seed % 2 == 0 ? test::uniform_points(150, seed) : test::bumpy_sphere_points(150, seed);
    const auto expected = quadruples(exact_voronoi(points).diagram);
    for (const VoronoiAlgorithm algorithm : kVoronoiAlgorithms) {
      const auto [diagram, report] = voronoi(points, algorithm);
      EXPECT_NO_THROW(validate(diagram));
      EXPECT_EQ(quadruples(diagram), expected) << name(algorithm) << ", seed " << seed;
      EXPECT_EQ(report.dimension, 3);
    }
  }
}

TEST(VoronoiAlgorithms, GiveFlatPointsNoVertices) {
  for (const auto& points : {test::Points{}, test::Points{{1, 2, 3}}, test::Points{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                             test::Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {3, 4, 0}}})
    for (const VoronoiAlgorithm algorithm : kVoronoiAlgorithms) {
      const VoronoiDiagram diagram = voronoi(points, algorithm).diagram;
      EXPECT_EQ(diagram.points, points);
      EXPECT_TRUE(diagram.vertices.empty()) << name(algorithm);
    }
}

TEST(Bowyer, FailsLoudlyOnDegeneratePoints) {
  int failures = 0;
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    try {
      validate(bowyer_voronoi(points).diagram);  // where it does not fail, what it gives is consistent
    } catch (const InputError&) {
      ADD_FAILURE() << name << ": the points are not at fault";
    } catch (const Error& error) {
      ++failures;
      EXPECT_NE(std::string(error.what()).find("Bowyer's algorithm fails at point "), std::string::npos) << name;
    }
  }
  EXPECT_GE(failures, 20);
}

TEST(Inagaki, IsConsistentOnDegeneratePoints) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    VoronoiDiagram diagram;
    ASSERT_NO_THROW(diagram = inagaki_voronoi(points).diagram) << name;
    EXPECT_NO_THROW(validate(diagram)) << name;
  }
}

// Chapter 6 reports four to eight orders of magnitude between the two, on its faucet and its ship.
void expect_far_more_accurate(const std::string& name, const test::Points& points) {
  const double radius = test::bounding_radius(points);
  const auto [inagaki, coarse] = inagaki_voronoi(points);
  const auto [highest_first, fine] = highest_first_voronoi(points);
  EXPECT_GT(inaccuracy(inagaki).mean, 1e-5 * radius) << name;
  EXPECT_LT(inaccuracy(highest_first).mean, 1e-15 * radius) << name;
  EXPECT_GT(coarse.coplanar_centers, 10 * fine.coplanar_centers) << name;
}

TEST(Inagaki, IsOrdersOfMagnitudeLessAccurateThanHighestFirst) {
  expect_far_more_accurate("box", test::relaxed_box_points(1000, 1));
  expect_far_more_accurate("lattice", test::box_lattice_points(12));
  for (const char* model : {"lamp", "faucet", "ship"}) {
    const auto file = std::filesystem::path(ORCHARD_DATA_DIR) / (std::string(model) + ".obj");
    const Surface surface(read_mesh(file));
    expect_far_more_accurate(model, sample_surface(surface, {.face_points = 1600, .edge_points = 400}).points);
  }
}

TEST(ConstrainedSearch, AloneFindsTheExactDiagramToo) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const test::Points points = seed % 2 == 0 ? test::uniform_points(120, seed) : test::torus_points(120, seed);
    const auto [diagram, report] = detail::build_voronoi(points, detail::Search::always_by_value, "test", {});
    validate(diagram);
    EXPECT_EQ(quadruples(diagram), quadruples(exact_voronoi(points).diagram)) << "seed " << seed;
    EXPECT_EQ(report.constrained_insertions, points.size() - 4);
  }
}

TEST(ConstrainedSearch, AloneIsConsistentOnDegeneratePoints) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    VoronoiDiagram diagram;
    ASSERT_NO_THROW(diagram = detail::build_voronoi(points, detail::Search::always_by_value, "test", {}).diagram)
        << name;
    EXPECT_NO_THROW(validate(diagram)) << name;
  }
}

}  // namespace
}  // namespace orchard
