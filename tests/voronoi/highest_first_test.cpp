#include "orchard/voronoi/highest_first.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "orchard/geometry/error.h"
#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/quality.h"
#include "voronoi/point_sets.h"

namespace orchard {
namespace {

using Four = std::array<Index, 4>;

std::vector<Four> sorted_forming_points(const VoronoiDiagram& diagram) {
  std::vector<Four> all;
  for (const VoronoiVertex& vertex : diagram.vertices) {
    all.push_back(vertex.forming_points);
    std::sort(all.back().begin(), all.back().end());
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(HighestFirstVoronoi, HasExactlyTheFormingPointsOfTheExactDiagram) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const std::size_t n = 10 + 7 * (seed % 40);
    const test::Points points = seed % 4 == 0   ? test::uniform_points(n, seed)
                                : seed % 4 == 1 ? test::bumpy_sphere_points(n, seed)
                                : seed % 4 == 2 ? test::torus_points(n, seed)
                                                : test::box_face_points(n, seed);
    const VoronoiDiagram diagram = highest_first_voronoi(points);
    ASSERT_NO_THROW(validate(diagram)) << "seed " << seed;
    ASSERT_EQ(sorted_forming_points(diagram), sorted_forming_points(exact_voronoi(points))) << "seed " << seed;
  }
}

TEST(HighestFirstVoronoi, IsConsistentOnDegeneratePoints) {
  for (const auto& [name, points] : test::degenerate_point_sets()) {
    InsertionReport report;
    VoronoiDiagram diagram;
    ASSERT_NO_THROW(diagram = highest_first_voronoi(points, {}, &report)) << name;
    EXPECT_NO_THROW(validate(diagram)) << name;
    Box box;
    for (const Point& p : points) box.extend(p);
    const double radius = box.diagonal().norm() / 2;
    EXPECT_LT(inaccuracy(diagram).max, 1e-9 * radius) << name;
  }
}

}  // namespace
}  // namespace orchard
