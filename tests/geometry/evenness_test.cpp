#include <gtest/gtest.h>

#include "orchard/geometry/sampling.h"
#include "support/shapes.h"

namespace orchard {
namespace {

TEST(Evenness, OfALatticeIsPerfect) {
  const Surface surface(TriangleMesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}});
  SurfaceSampling lattice;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      lattice.points.emplace_back(0.125 * i, 0.125 * j, 0);
      lattice.triangles.push_back(i < j ? 1 : 0);
      lattice.features.push_back(Feature::face);
      lattice.origins.push_back(PointOrigin::face);
    }
  const Evenness even = evenness(lattice, surface);
  EXPECT_EQ(even.mean, 0.125);
  EXPECT_EQ(even.min, 1);
  EXPECT_EQ(even.variation, 0);
  lattice.points[9].x() += 0.0625;  // now nearer to one of its neighbours, and that one to it
  EXPECT_LT(evenness(lattice, surface).min, 0.6);
  EXPECT_GT(evenness(lattice, surface).variation, 0.05);
}

TEST(Evenness, LooksAtOneSheetOfAThinObjectAtATime) {
  const Surface surface(test::box({0, 0, 0}, {1, 1, 1e-4}));
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 200, .edge_points = 0});
  EXPECT_GT(evenness(sampling, surface).mean, 0.05);
}

TEST(Evenness, FindsNeighboursHoweverFar) {
  const Surface surface(test::box({0, 0, 0}, {1000, 1, 1}));
  SurfaceSampling pair = sample_surface(surface, {.face_points = 4, .edge_points = 0});
  for (Index i = 0; i < pair.size(); ++i) {
    pair.points[i] = surface.corners(0)[0] + Vector(i == 0 ? 0 : 300, 0, 0);
    pair.triangles[i] = 0;
    pair.features[i] = Feature::face;
  }
  pair.points.resize(2), pair.triangles.resize(2), pair.features.resize(2), pair.origins.resize(2);
  EXPECT_EQ(evenness(pair, surface).mean, 300);
  pair.points.resize(1);
  EXPECT_EQ(evenness(pair, surface).mean, 0);
}

}  // namespace
}  // namespace orchard
