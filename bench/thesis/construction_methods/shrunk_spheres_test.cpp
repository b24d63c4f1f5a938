#include "shrunk_spheres.h"

#include <gtest/gtest.h>

#include <numeric>

#include "orchard/geometry/mesh_io.h"

namespace orchard::construction_methods {
namespace {

Surface lamp() { return Surface(read_mesh(ORCHARD_DATA_DIR "/lamp.obj")); }

std::vector<Index> all_of(const SurfaceSampling& sampling) {
  std::vector<Index> all(sampling.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

TEST(ShrunkSpheres, TouchTheirAnchorAndHoldNoPoint) {
  const Surface surface = lamp();
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 900, .edge_points = 200});
  const double slack = 1e-9 * surface.bounding_radius();
  for (const ShrunkSphere& shrunk : shrunk_spheres(surface, sampling, all_of(sampling))) {
    const auto& [center, radius] = shrunk.sphere;
    EXPECT_NEAR((sampling.points[shrunk.anchor] - center).norm(), radius, slack);
    for (const Point& p : sampling.points) ASSERT_GE((p - center).norm(), radius - slack);
    if (shrunk.stop == kNone) continue;
    EXPECT_NEAR((sampling.points[shrunk.stop] - center).norm(), radius, slack);
  }
}

TEST(ShrunkSpheres, ReachLessFarOutOfTheSolidTheMorePointsThereAre) {
  const Surface surface = lamp();
  const auto reach = [&](Index points) {
    const SurfaceSampling sampling = sample_surface(surface, {.face_points = points, .edge_points = points / 4});
    double sum = 0;
    const auto spheres = shrunk_spheres(surface, sampling, all_of(sampling));
    for (const ShrunkSphere& s : spheres)
      sum += std::max(0.0, s.sphere.radius + surface.signed_distance(s.sphere.center));
    return sum / static_cast<double>(spheres.size());
  };
  const double few = reach(100), some = reach(500), many = reach(2500);
  EXPECT_GT(few, 2 * some);
  EXPECT_GT(some, 2 * many);
}

TEST(ShrunkSpheres, HaveAnchorsThatAreSpreadAndDifferent) {
  const Surface surface = lamp();
  const SurfaceSampling sampling = sample_surface(surface, {.face_points = 400, .edge_points = 0});
  const auto anchors = spread_anchors(sampling, 60);
  ASSERT_EQ(anchors.size(), 60u);
  const auto nearest = [&](std::size_t count) {
    double least = 1e300;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t k = 0; k < i; ++k)
        least = std::min(least, (sampling.points[anchors[i]] - sampling.points[anchors[k]]).norm());
    return least;
  };
  EXPECT_GT(nearest(60), 0);
  EXPECT_GE(nearest(10), nearest(60));
  EXPECT_EQ(spread_anchors(sampling, 100'000).size(), sampling.size());
}

}  // namespace
}  // namespace orchard::construction_methods
