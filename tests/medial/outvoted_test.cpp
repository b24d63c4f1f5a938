#include "outvoted.h"

#include <gtest/gtest.h>

#include "support/shapes.h"

namespace orchard {
namespace {

// One vertex above four points around it, of which `facing` have a normal that points up towards it.
std::uint8_t verdict(const Surface& surface, int facing) {
  VoronoiDiagram diagram;
  diagram.points = {{0.4, 0.4, 1}, {0.6, 0.4, 1}, {0.6, 0.6, 1}, {0.4, 0.6, 1}};
  const Point center(0.5, 0.5, 1.3);
  diagram.vertices.push_back({center, (center - diagram.points[0]).norm(), {0, 1, 2, 3}, {kNone, kNone, kNone, kNone}});
  std::vector<Vector> normals;
  for (int i = 0; i < 4; ++i) normals.push_back({0, 0, i < facing ? 1.0 : -1.0});
  std::vector<std::uint8_t> inside{1};
  detail::drop_outvoted(surface, normals, diagram, inside);
  return inside[0];
}

TEST(Outvoted, ThreeFormingPointsOverruleTheNearestFeatureWhereTheSurfaceCutsItself) {
  const Surface cut(test::two_boxes(-0.5));
  EXPECT_EQ(verdict(cut, 4), 0);
  EXPECT_EQ(verdict(cut, 3), 0);
  EXPECT_EQ(verdict(cut, 2), 1);
}

TEST(Outvoted, NothingIsWhereTheSurfaceDoesNotCutItself) { EXPECT_EQ(verdict(Surface(test::two_boxes(0.5)), 4), 1); }

}  // namespace
}  // namespace orchard
