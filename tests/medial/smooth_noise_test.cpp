#include "quality/smooth_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

TEST(SmoothNoise, IsBoundedSmoothAndOfOneLengthWhateverTheSeed) {
  const Box box(Point(-1, 0, 2), Point(3, 1, 4));
  const double spacing = 0.2;
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 20 * test::more(); ++seed) {
    const detail::SmoothNoise noise(box, spacing, seed);
    Random random(seed, 1);
    double sum = 0;
    const int places = 500;
    for (int i = 0; i < places; ++i) {
      Point place;
      for (int axis = 0; axis < 3; ++axis) place[axis] = random.uniform(box.min()[axis], box.max()[axis]);
      const Vector here = noise(place);
      EXPECT_LE(here.norm(), 1 + 1e-12);
      sum += here.squaredNorm() / places;
      const Vector step = 1e-3 * spacing * Vector::UnitX();
      // The weights' slope is 1.5 at most, and neighbours differ by 2.
      EXPECT_LE((noise(place - step) - here).norm(), 3e-3);
      EXPECT_EQ(noise(place), here);
    }
    EXPECT_NEAR(std::sqrt(sum), 0.64, 0.06);  // 0.743^1.5, over weights and directions
    EXPECT_GT((noise(box.center()) - detail::SmoothNoise(box, spacing, seed + 1)(box.center())).norm(), 1e-3);
  }
}

TEST(ShortEdges, DivideTheSurfaceAndNothingElse) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 10 * test::more(); ++seed) {
    Random random(seed, 2);
    TriangleMesh mesh = seed % 2 == 0 ? test::torus(9, 5) : test::box({0, 0, 0}, {1, 2, 3});
    for (Point& vertex : mesh.vertices) {
      for (int axis = 0; axis < 3; ++axis) vertex[axis] += random.uniform(-0.05, 0.05);
    }
    const Surface before(mesh);
    const double max = random.uniform(0.05, 0.5) * before.bounding_box().diagonal().norm();
    const TriangleMesh divided = detail::with_short_edges(mesh, max);
    const Surface after(divided);
    EXPECT_TRUE(after.solid());
    EXPECT_NEAR(after.report().area, before.report().area, 1e-9 * before.report().area);
    EXPECT_NEAR(after.report().volume, before.report().volume, 1e-9 * before.report().volume);
    for (const auto& [a, b, c] : divided.triangles) {
      const Point &p = divided.vertices[a], &q = divided.vertices[b], &r = divided.vertices[c];
      EXPECT_LE(std::max({(p - q).norm(), (q - r).norm(), (r - p).norm()}), max);
    }
  }
}

}  // namespace
}  // namespace orchard
