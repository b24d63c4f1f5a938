#include "orchard/voronoi/quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "orchard/voronoi/exact.h"
#include "orchard/voronoi/inagaki.h"
#include "voronoi/point_sets.h"
#include "voronoi/predicates/quadruples.h"

namespace orchard {
namespace {

// The definition, by looking at all points: the sum, greatest and number of samples, in all and of each cell.
struct BruteForce {
  VoronoiInaccuracy all;
  std::vector<double> cells;

  BruteForce(const VoronoiDiagram& diagram, std::initializer_list<double> fractions) {
    Box box;
    for (const Point& p : diagram.points) box.extend(p);
    std::vector<double> sums(diagram.points.size()), counts(diagram.points.size());
    for (const VoronoiVertex& vertex : diagram.vertices) {
      if (vertex.at_infinity() || box.exteriorDistance(vertex.center) > 10 * box.diagonal().norm()) continue;
      for (const Index p : vertex.forming_points)
        for (const double fraction : fractions) {
          const Point sample = diagram.points[p] + fraction * (vertex.center - diagram.points[p]);
          double nearest = std::numeric_limits<double>::infinity();
          for (const Point& q : diagram.points) nearest = std::min(nearest, (sample - q).norm());
          const double excess = (sample - diagram.points[p]).norm() - nearest;
          all.mean += excess;
          all.max = std::max(all.max, excess);
          ++all.samples;
          sums[p] += excess;
          ++counts[p];
        }
    }
    all.mean /= static_cast<double>(all.samples);
    for (std::size_t p = 0; p < sums.size(); ++p) cells.push_back(counts[p] > 0 ? sums[p] / counts[p] : 0);
  }
};

void expect_near(const VoronoiInaccuracy& found, const VoronoiInaccuracy& expected) {
  EXPECT_NEAR(found.mean, expected.mean, 1e-12);
  EXPECT_NEAR(found.max, expected.max, 1e-12);
  EXPECT_EQ(found.samples, expected.samples);
}

TEST(Inaccuracy, IsTheDissertationsMeasure) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    // Inagaki's diagram of such points is wrong in many places.
    const VoronoiDiagram diagram = inagaki_voronoi(test::relaxed_box_points(150, seed)).diagram;
    const BruteForce expected(diagram, {0.25, 0.5, 0.75});
    EXPECT_GT(expected.all.mean, 1e-3);
    expect_near(inaccuracy(diagram), expected.all);
    const std::vector<double> cells = cell_inaccuracies(diagram);
    ASSERT_EQ(cells.size(), expected.cells.size());
    for (std::size_t p = 0; p < cells.size(); ++p) EXPECT_NEAR(cells[p], expected.cells[p], 1e-12);
    expect_near(corner_inaccuracy(diagram), BruteForce(diagram, {1.0}).all);
  }
}

TEST(Inaccuracy, OfAnExactDiagramIsRoundOff) {
  for (const auto& points : {test::uniform_points(1000, 1), test::torus_points(1000, 2),
                             test::relaxed_polyhedron_points(1000, 3), test::grid_points(8)}) {
    const VoronoiDiagram diagram = exact_voronoi(points).diagram;
    EXPECT_LT(inaccuracy(diagram).mean, 1e-16);
    EXPECT_LT(corner_inaccuracy(diagram).mean, 1e-15);
  }
}

TEST(Inaccuracy, SeesAMisplacedVertex) {
  VoronoiDiagram diagram = exact_voronoi(test::grid_points(5)).diagram;
  const auto vertex = std::find_if(diagram.vertices.begin(), diagram.vertices.end(),
                                   [](const VoronoiVertex& v) { return !v.at_infinity(); });
  vertex->center += Vector(2, 0, 0);
  EXPECT_GT(inaccuracy(diagram).max, 0.1);
  const std::vector<double> cells = cell_inaccuracies(diagram);
  EXPECT_GT(cells[vertex->forming_points[0]], 0.0);
  vertex->center.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(inaccuracy(diagram).max, std::numeric_limits<double>::infinity());
}

TEST(Inaccuracy, OfNothingIsZero) {
  const VoronoiDiagram flat = exact_voronoi(test::Points{{0, 0, 0}, {1, 0, 0}}).diagram;
  EXPECT_EQ(inaccuracy(flat).samples, 0u);
  EXPECT_EQ(inaccuracy(VoronoiDiagram{}).mean, 0);
  EXPECT_EQ(cell_inaccuracies(flat), (std::vector<double>{0, 0}));
}

}  // namespace
}  // namespace orchard
