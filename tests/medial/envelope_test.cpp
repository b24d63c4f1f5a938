// The mesh of the envelope: closed and manifold whatever the balls are, and in the right place.
#include "orchard/medial/envelope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "known_axes.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/topology.h"
#include "quality/reconstruction.h"

namespace orchard {
namespace {

double enclosed_volume(const TriangleMesh& mesh) {
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  return volume;
}

MedialMesh random_balls(std::uint64_t seed) {
  Random random(seed, 1);
  MedialMesh mesh;
  for (int v = 0; v < 14; ++v) {
    mesh.centers.emplace_back(random.uniform(), random.uniform(), random.uniform());
    mesh.radii.push_back(v % 3 == 0 ? 0 : random.uniform(0.02, 0.15));
  }
  for (Index t = 0; t < 5; ++t) mesh.triangles.push_back({t, t + 2, t + 5});
  for (Index e = 0; e < 4; ++e) mesh.edges.push_back({e, 9 + e});
  complete(mesh);
  return mesh;
}

TEST(EnvelopeMesh, IsABallsSurface) {
  MedialMesh mesh;
  mesh.centers = {{1, 2, 3}};
  mesh.radii = {0.7};
  const TriangleMesh envelope = envelope_mesh(mesh, {.cell = 0.02}).mesh;
  EXPECT_TRUE(Surface(envelope).solid());
  for (const Point& vertex : envelope.vertices) EXPECT_NEAR((vertex - mesh.centers[0]).norm(), 0.7, 1e-9);
  EXPECT_NEAR(enclosed_volume(envelope), 4.0 / 3 * std::numbers::pi * 0.7 * 0.7 * 0.7, 0.003);
}

TEST(EnvelopeMesh, HasTheVolumeOfARoundedTriangle) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {2, 0, 0}, {0.4, 1.5, 0}};
  mesh.radii = {0.3, 0.3, 0.3};
  mesh.triangles = {{0, 1, 2}};
  complete(mesh);
  const auto length = [&](Index a, Index b) { return (mesh.centers[a] - mesh.centers[b]).norm(); };
  const double r = 0.3, around = length(0, 1) + length(1, 2) + length(0, 2);
  const double volume = 2 * 1.5 * r + std::numbers::pi / 2 * around * r * r + 4.0 / 3 * std::numbers::pi * r * r * r;
  const TriangleMesh envelope = envelope_mesh(mesh, {.cell = 0.02}).mesh;
  EXPECT_TRUE(Surface(envelope).solid());
  EXPECT_NEAR(enclosed_volume(envelope), volume, 0.005 * volume);
}

TEST(EnvelopeMesh, IsAClosedManifoldOfTheRightVolumeForAnyBalls) {
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    SCOPED_TRACE(seed);
    const MedialMesh mesh = random_balls(seed);
    const TriangleMesh envelope = envelope_mesh(mesh, {.cell = 1.0 / 80}).mesh;
    const Surface surface(envelope);
    EXPECT_TRUE(surface.solid()) << surface.report().faults();
    const detail::Reconstruction reconstruction(mesh);
    for (std::size_t i = 0; i < envelope.vertices.size(); i += 97)
      EXPECT_NEAR(reconstruction.distance(envelope.vertices[i]), 0, 1e-6);
    Box box = surface.bounding_box();
    Random random(seed, 2);
    int in = 0;
    constexpr int kCount = 50'000;
    for (int i = 0; i < kCount; ++i) {
      const Point query =
          box.min() + box.sizes().cwiseProduct(Vector(random.uniform(), random.uniform(), random.uniform()));
      in += reconstruction.distance(query) < 0 ? 1 : 0;
    }
    const double expected = box.volume() * in / kCount;
    const double sigma = box.volume() * std::sqrt(static_cast<double>(in)) / kCount;
    EXPECT_NEAR(enclosed_volume(envelope), expected, 0.01 * expected + 3 * sigma);
  }
}

TEST(EnvelopeMesh, HasTheTopologyOfARing) {
  MedialMesh ring;
  constexpr Index kCount = 40;
  for (Index i = 0; i < kCount; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCount;
    ring.centers.emplace_back(std::cos(angle), std::sin(angle), 0);
    ring.radii.push_back(0.2);
    ring.edges.push_back({i, (i + 1) % kCount});
  }
  complete(ring);
  const Surface surface(envelope_mesh(ring, {.cell = 0.02}).mesh);
  EXPECT_EQ(solid_topology(surface), (Topology{1, 1, 0}));
}

TEST(EnvelopeMesh, CountsBallsThatAreLostBetweenItsCells) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {0.2, 0.01, 0.005}, {0, 0.18, 0.02}};
  mesh.radii = {0.05, 0.004, 0.003};
  const EnvelopeMesh coarse = envelope_mesh(mesh, {.cell = 0.05}), fine = envelope_mesh(mesh, {.cell = 4e-3});
  EXPECT_EQ(coarse.lost, 2U);
  EXPECT_EQ(solid_topology(Surface(coarse.mesh)).components, 1);
  EXPECT_EQ(fine.lost, 0U);
  EXPECT_EQ(solid_topology(Surface(fine.mesh)).components, 3);
}

// The tip of a cone is cut off, but not the cone.
TEST(EnvelopeMesh, LosesNoBallWhereOnlyAnEdgeIsCutOff) {
  MedialMesh mesh;
  mesh.centers = {{0, 0, 0}, {0.9, 0, 0}, {0.99, 0, 0}};
  mesh.radii = {0.3, 0.03, 0.003};
  mesh.edges = {{0, 1}, {1, 2}};
  EXPECT_EQ(envelope_mesh(mesh, {.cell = 0.02}).lost, 0U);
}

TEST(EnvelopeMesh, RefusesWhatHasNoInside) {
  MedialMesh point;
  point.centers = {{1, 2, 3}};
  point.radii = {0};
  EXPECT_THROW(envelope_mesh(point), InputError);
  MedialMesh ball = point;
  ball.radii = {1};
  EXPECT_THROW(envelope_mesh(ball, {.cell = 0}), InputError);
}

}  // namespace
}  // namespace orchard
