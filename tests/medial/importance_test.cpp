#include "orchard/medial/importance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "support/shapes.h"

namespace orchard {
namespace {

// A plate of thickness 1. Its axis has a middle sheet at x = 1/2, and a sheet into each edge.
class ImportanceOfAPlate : public testing::Test {
 protected:
  ImportanceOfAPlate() : surface_(plate()), axis_(axis_of_plate()) {}

  static const Surface& plate() {
    static const Surface surface(test::box({0, 0, 0}, {1, 4, 4}));
    return surface;
  }
  static const MedialAxis& axis_of_plate() {
    static const MedialAxis axis = [] {
      MedialBuildOptions options{.sampling = {.face_points = 1600, .edge_points = 400}, .check_promise = false};
      options.refine.emplace();
      return build_medial_axis(plate(), options).axis;
    }();
    return axis;
  }

  // Calls check(v, distance to the nearest rim) for vertices within the middle sheet, away from its diagonals.
  template <class Check>
  void for_middle(const Check& check) const {
    int checked = 0;
    for (Index v = 0; v < axis_.size(); ++v) {
      const Point& at = axis_.centers[v];
      const double y = std::min(at.y(), 4 - at.y()), z = std::min(at.z(), 4 - at.z());
      if (std::abs(at.x() - 0.5) > 1e-9 || std::min(y, z) < 0.7) continue;
      check(v, std::min(y, z));
      ++checked;
    }
    EXPECT_GT(checked, 20);
  }
  // Calls check(v, radius) for vertices within the sheets into the four edges at z = 0 and 4 along y, away from
  // corners.
  template <class Check>
  void for_sheets_into_edges(const Check& check) const {
    int checked = 0;
    for (Index v = 0; v < axis_.size(); ++v) {
      const Point& at = axis_.centers[v];
      const double x = std::min(at.x(), 1 - at.x()), z = std::min(at.z(), 4 - at.z());
      if (std::abs(x - z) > 1e-9 || x < 0.02 || x > 0.45 || std::abs(at.y() - 2) > 1) continue;
      check(v, x);
      ++checked;
    }
    EXPECT_GT(checked, 10);
  }

  const Surface& surface_;
  const MedialAxis& axis_;
};

TEST_F(ImportanceOfAPlate, IsTheClosedFormByContacts) {
  const std::vector<double> angle = importance(surface_, axis_, ImportanceMeasure::angle),
                            loss = importance(surface_, axis_, ImportanceMeasure::border_loss),
                            lambda = importance(surface_, axis_, ImportanceMeasure::lambda);
  for_middle([&](Index v, double) {
    EXPECT_NEAR(angle[v], std::numbers::pi, 1e-6);
    EXPECT_GT(loss[v], 1e3);
    EXPECT_NEAR(lambda[v], 0.5, 1e-9);
  });
  for_sheets_into_edges([&](Index v, double radius) {
    EXPECT_NEAR(angle[v], std::numbers::pi / 2, 1e-6);
    EXPECT_NEAR(loss[v], radius * (std::sqrt(2.0) - 1), 1e-6);
    EXPECT_NEAR(lambda[v], radius / std::sqrt(2.0), 1e-6);
  });
}

// Along a sheet into an edge, the centre of a ball is sqrt(2) times as far from the largest ball beside it as its
// radius is smaller.
TEST_F(ImportanceOfAPlate, IsTheClosedFormByScale) {
  const std::vector<double> scale = importance(surface_, axis_, ImportanceMeasure::scale);
  for_sheets_into_edges([&](Index v, double) {
    EXPECT_GE(scale[v], std::sqrt(2.0) - 1e-6);
    EXPECT_LE(scale[v], 1.8) << "the largest balls are some edges apart";
  });
  for_middle([&](Index v, double) { EXPECT_GT(scale[v], 100); });
}

// The fire runs from an edge over a sheet of width sqrt(2) / 2, and then along the middle.
TEST_F(ImportanceOfAPlate, IsTheClosedFormByErosion) {
  const std::vector<double> erosion = importance(surface_, axis_, ImportanceMeasure::erosion);
  for_sheets_into_edges([&](Index v, double radius) { EXPECT_NEAR(erosion[v], (std::sqrt(2.0) - 1) * radius, 0.03); });
  for_middle([&](Index v, double rim) { EXPECT_NEAR(erosion[v], std::sqrt(0.5) + (rim - 0.5) - 0.5, 0.08); });
}

TEST_F(ImportanceOfAPlate, IsTheClosedFormByPathsOnTheSurface) {
  const std::vector<double> geodesic = importance(surface_, axis_, ImportanceMeasure::geodesic);
  const double edge = surface_.bounding_box().diagonal().norm() / 128;
  for_middle([&](Index v, double rim) {
    EXPECT_GE(geodesic[v], (1 + 2 * rim) * (1 - 1e-5));
    EXPECT_LE(geodesic[v], 1.05 * (1 + 2 * rim) + edge);
  });
  for_sheets_into_edges([&](Index v, double radius) {
    EXPECT_GE(geodesic[v], 2 * radius * (1 - 1e-5));
    EXPECT_LE(geodesic[v], 1.05 * 2 * radius + edge);
  });
}

TEST(Importance, ByPathsIsAnArcAroundTheTubeOfATorus) {
  const Surface surface(test::torus(64, 32));
  MedialBuildOptions options{.sampling = {.face_points = 800, .edge_points = 0}, .check_promise = false};
  options.refine.emplace();
  const MedialAxis axis = build_medial_axis(surface, options).axis;
  const std::vector<double> geodesic = importance(surface, axis, ImportanceMeasure::geodesic),
                            angle = importance(surface, axis, ImportanceMeasure::angle);
  const double edge = surface.bounding_box().diagonal().norm() / 128;
  int checked = 0;
  for (Index v = 0; v < axis.size(); ++v) {
    if (angle[v] < 2) continue;  // contacts on one circle around the tube, up to the facets
    EXPECT_GE(geodesic[v], 2 * axis.radii[v] * std::sin(angle[v] / 2) * (1 - 1e-5));
    EXPECT_LE(geodesic[v], 1.06 * angle[v] * axis.radii[v] + edge);
    ++checked;
  }
  EXPECT_GT(checked, 20);
}

TEST(Importance, ByPathsIsInfiniteBetweenComponentsOfTheSurface) {
  TriangleMesh mesh = test::box({0, 0, 0}, {4, 4, 4});
  const TriangleMesh hole = test::box({1, 1, 1}, {3, 3, 3});
  const auto first = static_cast<Index>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), hole.vertices.begin(), hole.vertices.end());
  for (const auto& [a, b, c] : hole.triangles) mesh.triangles.push_back({first + a, first + c, first + b});
  const Surface surface(mesh);
  const MedialAxis axis = build_medial_axis(surface, {.sampling = {.face_points = 1600, .edge_points = 400}}).axis;
  const std::vector<double> geodesic = importance(surface, axis, ImportanceMeasure::geodesic);
  EXPECT_TRUE(std::any_of(geodesic.begin(), geodesic.end(), [](double x) { return std::isinf(x); }));
  EXPECT_TRUE(std::any_of(geodesic.begin(), geodesic.end(), [](double x) { return std::isfinite(x) && x > 0; }));
}

TEST(Importance, ByScaleAgreesWithEveryPairOfBalls) {
  const Surface surface(test::icosphere(1));
  for (const std::uint64_t seed : {9u, 10u, 11u}) {
    MedialAxis balls;
    for (Index i = 0; i < 300; ++i) {
      Random random(seed, i);
      balls.centers.emplace_back(random.uniform(), random.uniform(), random.uniform());
      balls.radii.push_back(random.uniform(0.01, 0.4));
    }
    const std::vector<double> scale = importance(surface, balls, ImportanceMeasure::scale);
    for (Index i = 0; i < balls.size(); ++i) {
      double expected = std::numeric_limits<double>::infinity();
      for (Index k = 0; k < balls.size(); ++k) {
        if (balls.radii[k] > balls.radii[i])
          expected =
              std::min(expected, (balls.centers[i] - balls.centers[k]).norm() / (balls.radii[k] - balls.radii[i]));
      }
      expected = std::max(expected, 1.0);
      EXPECT_TRUE(scale[i] == expected || std::abs(scale[i] - expected) < 1e-9 * expected) << i;
    }
  }
}

TEST(Importance, DoesNotDependOnScalingByAPowerOfTwo) {
  TriangleMesh mesh = test::l_shape();
  const Surface surface(mesh);
  for (Point& vertex : mesh.vertices) vertex *= 8;
  const Surface larger(mesh);
  const MedialBuildOptions options{.sampling = {.face_points = 400, .edge_points = 100}};
  const MedialAxis axis = build_medial_axis(surface, options).axis, scaled = build_medial_axis(larger, options).axis;
  for (const ImportanceMeasure measure : kImportanceMeasures) {
    const double unit = measure == ImportanceMeasure::angle || measure == ImportanceMeasure::scale ? 1 : 8;
    std::vector<double> values = importance(surface, axis, measure);
    for (double& value : values) value *= unit;
    EXPECT_EQ(values, importance(larger, scaled, measure)) << static_cast<int>(measure);
  }
}

TEST(Importance, RefusesAnAxisWithoutVertices) {
  EXPECT_THROW(importance(Surface(test::icosphere(1)), {}, ImportanceMeasure::lambda), InputError);
}

}  // namespace
}  // namespace orchard
