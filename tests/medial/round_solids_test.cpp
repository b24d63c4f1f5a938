// Solids that are round but for their facets: each wedge between two of these is worth next to nothing, and all of them
// together are the solid.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "orchard/geometry/random.h"
#include "orchard/medial/build.h"
#include "orchard/medial/medial_mesh.h"
#include "orchard/medial/topology.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Profile = std::vector<std::array<double, 2>>;

struct RoundSolid {
  std::string name;
  TriangleMesh mesh;
};

Profile capsule(double radius, double height, int steps) {
  Profile profile;
  for (int end = 0; end < 2; ++end) {
    for (int i = 0; i <= steps; ++i) {
      const double angle = std::numbers::pi / 2 * (end == 0 ? i : steps - i) / steps;
      const double rise = radius * std::cos(angle);
      profile.push_back({angle > 0 ? radius * std::sin(angle) : 0, end == 0 ? -height / 2 - rise : height / 2 + rise});
    }
  }
  return profile;
}

std::vector<RoundSolid> named_solids() {
  return {{"cylinder", test::turned({{1, 0}, {1, 4}}, 24)},
          {"fine cylinder", test::turned({{1, 0}, {1, 3}}, 128)},
          {"disc", test::turned({{2, 0}, {2, 0.8}}, 64)},
          {"cone", test::turned({{1, 0}, {0, 3}}, 48)},
          {"capsule", test::turned(capsule(1, 2, 8), 32)},
          {"shaft", test::turned({{1, 0}, {1, 2}, {0.6, 2}, {0.6, 5}, {1.2, 5}, {1.2, 6}}, 36)}};
}

RoundSolid random_solid(std::uint64_t seed) {
  Random random(seed, 0x726f756e64, 0);
  const auto within = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  const int around = static_cast<int>(within(18, 200));
  Profile profile;
  double height = 0;
  const int steps = static_cast<int>(within(1, 5));
  for (int i = 0; i <= steps; ++i) {
    profile.push_back({within(0.4, 1.2), height});
    height += within(0.5, 2);
  }
  if (random.uniform() < 0.3) profile.push_back({0, height});
  return {"seed " + std::to_string(seed), test::turned(profile, around)};
}

// The distance of a point to balls sampled densely on all cells: a little more than that to the cells. By brute force.
double distance_to_balls(const Point& query, const MedialMesh& mesh) {
  constexpr int kParts = 12;
  double least = std::numeric_limits<double>::infinity();
  const auto ball = [&](const Point& center, double radius) {
    least = std::min(least, (query - center).norm() - radius);
  };
  for (std::size_t v = 0; v < mesh.centers.size(); ++v) ball(mesh.centers[v], mesh.radii[v]);
  for (const auto& [a, b] : mesh.edges) {
    for (int i = 1; i < kParts; ++i) {
      const double t = static_cast<double>(i) / kParts;
      ball((1 - t) * mesh.centers[a] + t * mesh.centers[b], (1 - t) * mesh.radii[a] + t * mesh.radii[b]);
    }
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    ball((mesh.centers[a] + mesh.centers[b] + mesh.centers[c]) / 3,
         (mesh.radii[a] + mesh.radii[b] + mesh.radii[c]) / 3);
  }
  return least;
}

// The largest distance of 400 places of the surface to the axis, in diagonals.
double left_open(const Surface& surface, const MedialMesh& mesh) {
  std::vector<Point> places = surface.mesh().vertices;
  for (Index t = 0; t < surface.mesh().triangles.size(); ++t) {
    const auto [a, b, c] = surface.corners(t);
    places.push_back((a + b + c) / 3);
  }
  const std::size_t step = places.size() / 400 + 1;
  std::vector<double> open((places.size() + step - 1) / step);
  tbb::parallel_for(std::size_t{0}, open.size(),
                    [&](std::size_t i) { open[i] = distance_to_balls(places[i * step], mesh); });
  return *std::max_element(open.begin(), open.end()) / surface.bounding_box().diagonal().norm();
}

void expect_whole_axis(const RoundSolid& solid, Index points) {
  SCOPED_TRACE(solid.name);
  const Surface surface(solid.mesh);
  ASSERT_TRUE(surface.solid());
  const MedialBuild build = build_medial_axis(
      surface,
      {.sampling = {.face_points = points - points / 5, .edge_points = points / 5}, .refine = RefineOptions{}});
  const MedialMesh mesh = medial_mesh(build.axis);
  EXPECT_EQ(topology(mesh), solid_topology(surface));
  EXPECT_TRUE(build.promise.kept()) << build.promise.open << " open, " << build.promise.protrusion << " sticking out";
  EXPECT_LT(left_open(surface, mesh), 0.01);
}

TEST(RoundSolids, HaveAnAxisThatReachesAllOfTheirSurface) {
  for (const RoundSolid& solid : named_solids()) expect_whole_axis(solid, 1500);
}

TEST(RoundSolids, OfRandomProfilesHaveAnAxisThatReachesAllOfTheirSurface) {
  for (std::uint64_t i = 0; i < 2 * test::more(); ++i) expect_whole_axis(random_solid(test::first_seed() + i), 1500);
}

// A ball of noise: with few points, what Newton's method finds from a vertex may be a ball on the other side.
TriangleMesh noisy_ball(int subdivisions, double noise, std::uint64_t seed) {
  TriangleMesh mesh = test::icosphere(subdivisions);
  for (Index v = 0; v < mesh.vertices.size(); ++v)
    mesh.vertices[v] *= 1 + noise * (2 * Random(seed, 0x6e6f697365, v).uniform() - 1);
  return mesh;
}

TEST(RoundSolids, OfNoiseHaveNoBallOutside) {
  for (std::uint64_t i = 0; i < 2 * test::more(); ++i) {
    const std::uint64_t seed = test::first_seed() + i;
    SCOPED_TRACE(seed);
    const Surface surface(noisy_ball(3, 0.03, seed));
    ASSERT_TRUE(surface.solid());
    const MedialBuild build = build_medial_axis(
        surface, {.sampling = {.face_points = 160, .edge_points = 40, .seed = seed}, .refine = RefineOptions{}});
    for (Index v = 0; v < build.axis.size(); ++v)
      ASSERT_LT(build.axis.centers[v].norm() + build.axis.radii[v], 1.03 + 1e-9) << "vertex " << v;
  }
}

}  // namespace
}  // namespace orchard
