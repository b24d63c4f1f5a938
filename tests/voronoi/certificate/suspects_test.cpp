#include "certificate/suspects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "predicates/predicates.h"
#include "support/effort.h"
#include "voronoi/point_sets.h"

namespace orchard::detail {
namespace {

VoronoiVertex vertex_of(const std::array<Index, 4>& forming_points) {
  VoronoiVertex vertex;
  vertex.forming_points = forming_points;
  return vertex;
}

// A vertex of four points, none of which others form, in a set that only a part of forms vertices.
struct Suspect {
  Workspace workspace;
  FormingPoints forming;

  Suspect(const test::Points& points, std::array<Index, 4> four) : forming(points.size()) {
    workspace.points = points;
    const auto at = [&](unsigned i) { return points[four[i]]; };
    if (volume_sign(at(0), at(1), at(2), at(3)) == Sign::negative) std::swap(four[0], four[1]);
    workspace.vertices.push_back(vertex_of(four));
    forming.note(workspace.vertices[0]);
  }

  // The same by looking at each point.
  double deepest_of_all(double diameter) const {
    const auto corner = [&](unsigned i) { return workspace.points[workspace.vertices[0].forming_points[i]]; };
    Vector center;
    if (!sharp_circumcenter(corner(0), corner(1), corner(2), corner(3), center)) return diameter;
    double max = 0;
    for (Index i = 0; i < workspace.points.size(); ++i) {
      const Vector p = workspace.points[i] - corner(0);
      if (forming.has(i) &&
          inside_sphere(workspace.points[i], corner(0), corner(1), corner(2), corner(3)) == Sign::positive)
        max = std::max(max, 2 * center.dot(p) - p.squaredNorm());
    }
    return max / std::min(center.norm(), diameter / 2);
  }
};

// In blocks of neighbours, the last of which is not full; every other one in a plane that is not along the axes.
test::Points points_in_order(std::uint64_t seed) {
  test::Points points = test::uniform_points(1000, seed);
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.x() < b.x(); });
  for (std::size_t i = 0; i < points.size(); i += 2) points[i].z() = 0.25;
  return test::turned(points, seed);
}

TEST(PointBlocks, FindTheDeepestOfAllPointsThatFormVertices) {
  std::size_t found = 0;
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 100 * test::more(); ++seed) {
    const test::Points points = points_in_order(seed);
    const PointBlocks blocks(points);
    std::mt19937_64 random(seed);
    std::array<Index, 4> four{};
    for (Index& i : four) i = static_cast<Index>(random() % points.size());
    if (seed % 2 == 0)  // all in the plane: a sphere that is one nearly
      for (Index& i : four) i &= ~Index{1};
    Suspect suspect(points, four);
    for (int i = 0; i < 500; ++i) {
      std::array<Index, 4> others{};
      for (Index& other : others) other = static_cast<Index>(random() % points.size());
      suspect.forming.note(vertex_of(others));
    }
    const Intruder deepest = blocks.deepest_within(suspect.workspace, 0, suspect.forming, 2);
    EXPECT_EQ(deepest.depth, suspect.deepest_of_all(2)) << seed;
    found += deepest.point != kNone;
  }
  EXPECT_GT(found, 0);
}

}  // namespace
}  // namespace orchard::detail
