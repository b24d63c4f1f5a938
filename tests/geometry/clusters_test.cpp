#include "orchard/geometry/clusters.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "orchard/geometry/surface.h"
#include "support/shapes.h"

namespace orchard {
namespace {

Clusters clusters_of(const Surface& surface, double angle) {
  std::vector<Vector> normals;
  std::vector<std::array<Index, 3>> neighbors;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    normals.push_back(surface.normal(t));
    neighbors.push_back(surface.neighbors(t));
  }
  return find_clusters(normals, neighbors, angle);
}

void expect_partition(const Clusters& clusters) {
  Index first = 0;
  for (Index c = 0; c < clusters.count(); ++c) {
    const auto row = clusters.triangles[c];
    ASSERT_FALSE(row.empty());
    EXPECT_TRUE(std::ranges::is_sorted(row));
    if (c > 0) {
      EXPECT_GT(row[0], first) << "clusters go by their first triangle";
    }
    first = row[0];
    for (const Index t : row) EXPECT_EQ(clusters.of_triangle[t], c);
  }
  EXPECT_EQ(clusters.triangles.items.size(), clusters.of_triangle.size());
}

TEST(Clusters, OfABoxAreItsSides) {
  const Surface surface(test::box({0, 0, 0}, {1, 2, 3}));
  const Clusters& clusters = surface.clusters();
  EXPECT_EQ(clusters.count(), 6u);
  expect_partition(clusters);
  for (Index c = 0; c < 6; ++c) {
    ASSERT_EQ(clusters.triangles[c].size(), 2u);
    EXPECT_EQ(surface.normal(clusters.triangles[c][0]), surface.normal(clusters.triangles[c][1]));
  }
}

TEST(Clusters, HoldAdjacentTrianglesOnly) {
  // The parallel faces of the two boxes, and of the L's steps, face the same way but do not touch.
  EXPECT_EQ(Surface(test::two_boxes(0.5)).clusters().count(), 12u);
  EXPECT_EQ(Surface(test::l_shape()).clusters().count(), 8u);
}

TEST(Clusters, OfACurvedSurfaceAreSingleTriangles) {
  const Surface surface(test::icosphere(2));
  EXPECT_EQ(surface.clusters().count(), surface.mesh().triangles.size());
  expect_partition(surface.clusters());
}

TEST(Clusters, StayWithinTheAngleOfTheirFirstTriangle) {
  const Surface surface(test::icosphere(3));
  for (const double angle : {0.15, 0.3, 0.6}) {
    const Clusters clusters = clusters_of(surface, angle);
    expect_partition(clusters);
    EXPECT_LT(clusters.count(), surface.mesh().triangles.size());
    for (Index c = 0; c < clusters.count(); ++c) {
      const Vector& first = surface.normal(clusters.triangles[c][0]);
      for (const Index t : clusters.triangles[c])
        EXPECT_LE(std::acos(std::min(1.0, first.dot(surface.normal(t)))), angle + 1e-7);
    }
  }
}

TEST(Clusters, AreConnectedAcrossEdges) {
  const Surface surface(test::torus(30, 15));
  const Clusters clusters = clusters_of(surface, 0.4);
  for (Index c = 0; c < clusters.count(); ++c) {
    std::set<Index> reached{clusters.triangles[c][0]};
    std::vector<Index> stack{clusters.triangles[c][0]};
    while (!stack.empty()) {
      const Index t = stack.back();
      stack.pop_back();
      for (const Index n : surface.neighbors(t))
        if (n != kNone && clusters.of_triangle[n] == c && reached.insert(n).second) stack.push_back(n);
    }
    EXPECT_EQ(reached.size(), clusters.triangles[c].size());
  }
}

TEST(Clusters, DoNotCrossBoundariesOrFoldBack) {
  EXPECT_EQ(Surface(test::open_box()).clusters().count(), 5u);
  // Two triangles back to back are adjacent but face opposite ways.
  const Surface leaf(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 2, 3}}});
  EXPECT_EQ(leaf.clusters().count(), 2u);
}

TEST(Clusters, OfNothingAreNone) { EXPECT_EQ(find_clusters({}, {}, 0.1).count(), 0u); }

}  // namespace
}  // namespace orchard
