#include "orchard/geometry/noise.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface.h"
#include "support/effort.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using namespace test;

double diagonal_length(const TriangleMesh& mesh) {
  Box box;
  for (const Point& vertex : mesh.vertices) box.extend(vertex);
  return box.diagonal().norm();
}

std::vector<Vector> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vector> normals(mesh.vertices.size(), Vector::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector across = (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    for (const Index corner : {a, b, c}) normals[corner] += across;
  }
  for (Vector& normal : normals) normal.normalize();
  return normals;
}

// Normal noise along the normals, by Box and Muller.
TriangleMesh with_noise(TriangleMesh mesh, double deviation, std::uint64_t seed) {
  const std::vector<Vector> normals = vertex_normals(mesh);
  const double deviation = deviation * diagonal_length(mesh);
  Random random(seed, 7);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double radius = std::sqrt(-2 * std::log(1 - random.uniform(0, 1)));
    mesh.vertices[v] += deviation * radius * std::cos(random.uniform(0, 2 * std::numbers::pi)) * normals[v];
  }
  return mesh;
}

// The cube [0, cells]^3, whose sides are grids of squares in two triangles each, so that it can have noise.
TriangleMesh grid_box(int cells) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, Index> numbers;
  const auto corner = [&](const std::array<int, 3>& at) {
    const auto [place, is_new] = numbers.try_emplace(at, static_cast<Index>(mesh.vertices.size()));
    if (is_new) mesh.vertices.emplace_back(at[0], at[1], at[2]);
    return place->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {0, cells})
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) {
          const auto at = [&](int u, int v) {
            std::array<int, 3> place{};
            place[axis] = side, place[(axis + 1) % 3] = u, place[(axis + 2) % 3] = v;
            return corner(place);
          };
          Index a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          if (side == 0) std::swap(b, d);
          mesh.triangles.push_back({a, b, c});
          mesh.triangles.push_back({a, c, d});
        }
  return mesh;
}

double root_mean_square(const TriangleMesh& mesh, const TriangleMesh& clean) {
  const std::vector<Vector> normals = vertex_normals(clean);
  double sum = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    sum += std::pow((mesh.vertices[v] - clean.vertices[v]).dot(normals[v]), 2);
  return std::sqrt(sum / static_cast<double>(mesh.vertices.size())) / diagonal_length(clean);
}

TEST(NoiseDeviation, IsFoundWithinAFifth) {
  for (const TriangleMesh& clean : {icosphere(4), grid_box(16), torus(48, 24)})
    for (const double deviation : {0.001, 0.003, 0.006})
      for (std::uint64_t seed = first_seed(); seed < first_seed() + 3 * more(); ++seed)
        EXPECT_NEAR(noise_deviation(with_noise(clean, deviation, seed)), deviation, 0.2 * deviation) << seed;
}

TEST(NoiseDeviation, OfCleanMeshesIsLow) {
  for (const TriangleMesh& clean : {icosphere(4), torus(48, 24)}) EXPECT_LT(noise_deviation(clean), 1e-4);
  EXPECT_EQ(noise_deviation(l_shape()), 0);
  EXPECT_EQ(noise_deviation(grid_box(16)), 0) << "its sides are flat";
}

TEST(NoiseDeviation, DoesNotDependOnSizeOrThreads) {
  TriangleMesh mesh = with_noise(icosphere(3), 0.004, 5);
  const double deviation = noise_deviation(mesh);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(noise_deviation(mesh), deviation);
  }
  for (Point& vertex : mesh.vertices) vertex *= 0x1p-20;
  EXPECT_EQ(noise_deviation(mesh), deviation);
}

TEST(Denoise, BringsTheSurfaceBackToWithinHalfOfTheNoise) {
  for (const TriangleMesh& clean : {icosphere(4), grid_box(16), torus(96, 48)})
    for (const double deviation : {0.001, 0.003, 0.006})
      for (std::uint64_t seed = first_seed(); seed < first_seed() + 3 * more(); ++seed) {
        const DenoisedMesh smooth = denoise(with_noise(clean, deviation, seed), {.deviation = deviation});
        EXPECT_LT(root_mean_square(smooth.mesh, clean), 0.55 * deviation) << deviation;
        EXPECT_LE(smooth.moved_max, 3 * deviation * (1 + 1e-9));
        EXPECT_EQ(smooth.mesh.triangles, clean.triangles);
      }
}

TEST(Denoise, KeepsTheEdgesOfABox) {
  const TriangleMesh clean = grid_box(16);
  const DenoisedMesh smooth = denoise(with_noise(clean, 0.002, 2), {.deviation = 0.002});
  double worst = 0;
  for (std::size_t v = 0; v < clean.vertices.size(); ++v) {
    const Point& at = clean.vertices[v];
    const bool on_edge = (at.array() == 0).count() + (at.array() == 16).count() >= 2;
    if (on_edge) worst = std::max(worst, (smooth.mesh.vertices[v] - at).norm());
  }
  EXPECT_LT(worst, 4 * 0.002 * diagonal_length(clean));
}

TEST(Denoise, DoesNotDependOnSizeOrThreads) {
  TriangleMesh mesh = with_noise(icosphere(3), 0.004, 5);
  const DenoisedMesh smooth = denoise(mesh, {.deviation = 0.004});
  EXPECT_GT(smooth.rounds, 0);
  {
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    EXPECT_EQ(denoise(mesh, {.deviation = 0.004}).mesh.vertices, smooth.mesh.vertices);
  }
  for (Point& vertex : mesh.vertices) vertex *= 0x1p10;
  const DenoisedMesh larger = denoise(mesh, {.deviation = 0.004});
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    ASSERT_EQ(larger.mesh.vertices[v], Point(smooth.mesh.vertices[v] * 0x1p10));
}

TEST(Denoise, LeavesTheMeshWithoutNoiseOrRounds) {
  const TriangleMesh mesh = with_noise(icosphere(2), 0.004, 5);
  EXPECT_EQ(denoise(mesh, {.deviation = 0}).mesh.vertices, mesh.vertices);
  EXPECT_EQ(denoise(mesh, {.deviation = 0.004, .max_rounds = 0}).mesh.vertices, mesh.vertices);
}

TEST(Denoise, LeavesAFlatMeshInItsPlane) {
  const TriangleMesh square{{Point(0, 0, 0), Point(1, 0, 0), Point(1, 1, 0), Point(0, 1, 0)}, {{0, 1, 2}, {0, 2, 3}}};
  for (const Point& vertex : denoise(square, {.deviation = 0.01}).mesh.vertices) EXPECT_EQ(vertex.z(), 0);
}

TEST(Denoise, RefusesDeviationsOutOfRange) {
  const TriangleMesh mesh = icosphere(1);
  for (const double deviation : {-0.001, 0.051, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(denoise(mesh, {.deviation = deviation}), InputError) << deviation;
  EXPECT_THROW(denoise(mesh, {.deviation = 0.001, .max_rounds = -1}), InputError);
}

}  // namespace
}  // namespace orchard
