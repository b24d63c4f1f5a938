// What local thickness promises where a search ends before it is complete.
#include <gtest/gtest.h>

#include <cmath>

#include "orchard/medial/thickness.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr Index kComplete = 1'000'000;

struct Seen {
  int inexact = 0, undecided = 0;
};

// Checks every value of searches that end early against those of complete ones.
Seen compare(const Surface& surface, Index work) {
  const ThicknessValues right = local_thickness(surface, {.samples = 1, .work = kComplete}).at_vertices,
                        found = local_thickness(surface, {.samples = 1, .work = work}).at_vertices;
  Seen seen;
  for (std::size_t i = 0; i < found.error.size(); ++i) {
    const double error = found.error[i], rounding = 1e-11 * right.ball_diameter[i];
    EXPECT_LE(right.error[i], rounding);
    EXPECT_GE(found.ball_diameter[i], right.ball_diameter[i] - rounding);
    EXPECT_LE(found.ball_diameter[i] - right.ball_diameter[i], error + rounding);
    seen.inexact += error > rounding;
    seen.undecided += std::isinf(error);
    if (std::isnan(right.thickness[i])) continue;
    if (std::isnan(found.thickness[i])) {
      EXPECT_TRUE(std::isinf(error)) << "place " << i << " has a thickness";
      continue;
    }
    EXPECT_LE(found.thickness[i] - right.thickness[i], error + rounding);
  }
  return seen;
}

TEST(ThicknessWork, ThatEndsASearchLeavesABoundOnTheError) {
  const Surface ball(test::icosphere(3));
  TriangleMesh mesh = test::torus(48, 20);
  for (Point& vertex : mesh.vertices) vertex.z() *= 1 + 0.2 * std::sin(7 * vertex.x());
  const Surface torus(mesh);
  for (const Surface* surface : {&ball, &torus}) {
    Seen all;
    for (const Index work : {1u, 10u, 60u, 300u}) {
      SCOPED_TRACE(work);
      const Seen seen = compare(*surface, work);
      all.inexact += seen.inexact;
      all.undecided += seen.undecided;
    }
    EXPECT_GT(all.inexact, 0);
    if (surface == &torus) {
      EXPECT_GT(all.undecided, 0);
    }
  }
}

}  // namespace
}  // namespace orchard
