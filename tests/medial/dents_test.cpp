// Dents of a reconstruction, from one depth to another below the surface, beside cubes and random places.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "known_axes.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/build.h"
#include "orchard/medial/refine.h"
#include "quality/boundary_reach.h"
#include "quality/deep_dents.h"
#include "quality/one_sided.h"
#include "quality/shell_dents.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr Index kMaxDentParts = 1'000'000;

// Reflex edges and vertices, saddles, sharp corners, flat faces in few triangles and long thin ones.
TriangleMesh shape(std::uint64_t kind, Random& random) {
  switch (kind) {
    case 0:
      return test::box(Point::Zero(), Point(1, 2, 3));
    case 1:
      return test::l_shape();
    case 2:
      return test::u_shape(0.3);
    case 3:
      return test::icosphere(2);
    case 4:
      return test::torus(16, 8);
    case 5:
      return test::torus(60, 4);
    default:
      break;
  }
  TriangleMesh rough = test::icosphere(2);  // a dented ball
  for (Point& vertex : rough.vertices) vertex *= random.uniform(0.7, 1);
  return rough;
}
constexpr std::uint64_t kShapes = 7;

// An axis of the solid whose balls are smaller by up to `share` each, and so leave dents.
MedialMesh shrunk_axis(const Surface& surface, double share, Random& random) {
  MedialBuildOptions options{.sampling = {.face_points = 120, .edge_points = 40}};
  options.refine.emplace();
  MedialMesh mesh = medial_mesh(build_medial_axis(surface, options).axis);
  for (double& radius : mesh.radii) radius *= 1 - share * random.uniform();
  return mesh;
}

double deepest_of_random_places(const Surface& surface, const MedialMesh& mesh,
                                const detail::Reconstruction& reconstruction, Random& random) {
  double deepest = 0;
  for (int i = 0; i < 5000; ++i) {
    std::array<Index, 3> cell{};
    if (mesh.triangles.empty()) {
      cell.fill(static_cast<Index>(random.below(mesh.size())));
    } else {
      cell = mesh.triangles[random.below(mesh.triangles.size())];
    }
    const auto& [a, b, c] = cell;
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const double radius = (1 - u - v) * mesh.radii[a] + u * mesh.radii[b] + v * mesh.radii[c];
    const Vector way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const Point place =
        (1 - u - v) * mesh.centers[a] + u * mesh.centers[b] + v * mesh.centers[c] + radius * way.normalized();
    if (reconstruction.distance(place) > -1e-9) deepest = std::max(deepest, -surface.signed_distance(place));
  }
  return deepest;
}

TEST(Dents, BelowTheSurfaceAreThoseThatCubesFind) {
  for (std::uint64_t seed = test::first_seed(), end = seed + kShapes * test::more(); seed < end; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 3);
    const Surface surface(shape(seed % kShapes, random));
    const double diagonal = surface.bounding_box().diagonal().norm();
    const MedialMesh mesh = shrunk_axis(surface, random.uniform(0, 0.1), random);
    const detail::Reconstruction reconstruction(mesh);
    const double known = 0.01 * diagonal, accuracy = 1e-3 * diagonal;
    const auto in_cubes = detail::max_deep_dent(surface, reconstruction, known, accuracy, kMaxDentParts);
    const auto within = [&](double max) { return max + std::max(accuracy, 0.02 * max) + 1e-9; };
    ASSERT_TRUE(detail::one_sided(surface));
    const double deepest = deepest_of_random_places(surface, mesh, reconstruction, random);
    for (const auto& dent :
         {detail::max_shell_dent(surface, reconstruction, known, in_cubes.upper, accuracy, kMaxDentParts),
          detail::max_dent(surface, reconstruction, known, accuracy, kMaxDentParts)}) {
      EXPECT_LE(deepest, dent.upper);
      EXPECT_LE(in_cubes.max, dent.upper);
      EXPECT_LE(dent.max, in_cubes.upper);
      EXPECT_LE(dent.upper, within(std::max(dent.max, in_cubes.max)));
      if (!(dent.max > known)) continue;
      EXPECT_NEAR(-surface.signed_distance(dent.place), dent.max, 1e-12);
      EXPECT_NEAR(reconstruction.distance(dent.place), 0, 1e-9);
    }
  }
}

// What cubes would not come to the end of: the twelve balls of a box are the box.
TEST(Dents, OfAnExactBoxAreProvedToBeNone) {
  const test::KnownAxis known = test::known_box({1, 2, 3});
  const Surface box(known.solid);
  const detail::Reconstruction reconstruction(known.axis);
  const auto dent = detail::max_dent(box, reconstruction, 0, 1e-3, kMaxDentParts);
  EXPECT_LT(dent.max, 1e-12);
  EXPECT_LT(dent.upper, 1.1e-3);
}

TEST(Dents, AreLookedForOnBothSidesWhereTheSolidIs) {
  EXPECT_TRUE(detail::one_sided(Surface(test::two_boxes(0.5))));
  const TriangleMesh outer = test::icosphere(2, 2), inner = test::icosphere(1, 1);
  EXPECT_TRUE(detail::one_sided(Surface(test::joined({outer, test::mirrored(inner)}))));  // a cavity
  EXPECT_FALSE(detail::one_sided(Surface(test::joined({outer, inner}))));
  EXPECT_FALSE(detail::one_sided(Surface(test::joined({inner, test::transformed(inner, 1, Vector(1, 0, 0))}))));
}

}  // namespace
}  // namespace orchard
