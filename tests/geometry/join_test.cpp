#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "broken_meshes.h"
#include "orchard/geometry/mesh_check.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/min_ball.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/repair.h"
#include "support/effort.h"
#include "support/shapes.h"

// Corners that differ by rounding.
namespace orchard {
namespace {

using test::box;
using test::soup;

// A block with a bore of `count` sides through it.
TriangleMesh bored_block(Index count) {
  TriangleMesh mesh;
  const double pi = std::acos(-1.0);
  for (const double z : {0.0, 1.0})
    for (const double radius : {1.0, 2.5})
      for (Index i = 0; i < count; ++i) {
        const double angle = 2 * pi * i / count;
        mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
      }
  const auto quad = [&](Index a, Index b, Index c, Index d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  for (Index i = 0; i < count; ++i) {
    const Index k = (i + 1) % count, inner = 0, outer = count, up = 2 * count;
    quad(inner + i, inner + i + up, inner + k + up, inner + k);
    quad(outer + i, outer + k, outer + k + up, outer + i + up);
    quad(inner + i + up, outer + i + up, outer + k + up, inner + k + up);
    quad(inner + i, inner + k, outer + k, outer + i);
  }
  return mesh;
}

TriangleMesh any_solid(Random& random) {
  switch (random.below(6)) {
    case 0:
      return test::l_shape();
    case 1:
      return test::icosphere(2);
    case 2:
      return test::torus(12, 8);
    case 3:
      return test::u_shape(0.3);
    case 4:
      return bored_block(6 + static_cast<Index>(random.below(30)));
    default:
      return box({0, 0, 0}, {1, 2, 3});
  }
}

double radius_of(const TriangleMesh& mesh) { return ritter_ball(mesh.vertices).radius; }

TriangleMesh turned(TriangleMesh mesh, Random& random) {
  const auto turn =
      Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1))
          .normalized();
  for (Point& p : mesh.vertices) p = turn * p;
  return mesh;
}

// A bag of triangles, whose corners are up to `noise` off, some of them not at all.
TriangleMesh noisy(const TriangleMesh& mesh, double noise, Random& random) {
  TriangleMesh bag = soup(mesh);
  for (Point& p : bag.vertices)
    if (random.below(3) > 0)
      p += noise * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) / 2;
  return bag;
}

void expect_mended(const TriangleMesh& bag, const TriangleMesh& whole, const std::string& what) {
  TriangleMesh mesh = bag;
  const MeshRepairReport report = repair_mesh(mesh);
  const MeshReport found = check_mesh(mesh), wanted = check_mesh(whole);
  EXPECT_TRUE(report.solid) << what << ": " << report.faults;
  EXPECT_EQ(found.vertices, wanted.vertices) << what;
  EXPECT_EQ(found.triangles, wanted.triangles) << what;
  EXPECT_EQ(found.components, wanted.components) << what;
  EXPECT_EQ(report.holes_filled + report.cracks_closed, 0u) << what;
  EXPECT_LE(report.max_join, tolerance::kJoin * radius_of(whole) * (1 + 1e-3)) << what;
  EXPECT_NEAR(found.volume, wanted.volume, 1e-4 * wanted.volume) << what;
}

TEST(JoinedCorners, GiveTheSolidBackAtEveryScale) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 41);
    const double scale = std::pow(10.0, random.uniform(-6, 6)), noise = std::pow(10.0, random.uniform(-17, -4.7));
    const TriangleMesh whole =
        test::transformed(turned(any_solid(random), random), scale,
                          scale * Vector(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)));
    expect_mended(noisy(whole, noise * radius_of(whole), random), whole,
                  "seed " + std::to_string(seed) + ", noise " + std::to_string(std::log10(noise)));
  }
}

// What transcendental functions leave where zero is meant.
TEST(JoinedCorners, MayBeZeroBesideNearlyZero) {
  for (Index sides = 4; sides < 40; sides += 4) {
    Random random(sides, 42);
    const TriangleMesh whole = bored_block(sides);
    TriangleMesh bag = soup(whole);
    for (Point& p : bag.vertices)
      for (double& x : p)
        if (std::abs(x) < 1e-9) x = random.below(2) == 0 ? 0 : -2.7e-16;
    expect_mended(bag, whole, std::to_string(sides) + " sides");
  }
}

// Floats of the same place that one more rounding has made neighbours.
TEST(JoinedCorners, MayBeNeighbouringFloats) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 30 * test::more(); ++seed) {
    Random random(seed, 43);
    TriangleMesh whole = turned(any_solid(random), random);
    for (Point& p : whole.vertices)
      for (double& x : p) x = static_cast<float>(x);
    TriangleMesh bag = soup(whole);
    for (Point& p : bag.vertices)
      for (double& x : p)
        if (random.below(4) == 0) x = std::nextafter(static_cast<float>(x), random.below(2) == 0 ? 1e9F : -1e9F);
    expect_mended(bag, whole, "seed " + std::to_string(seed));
  }
}

// Places computed in floats, of which some fall beside others' when they are written with six digits.
TEST(JoinedCorners, MayDifferInTheSixthDigit) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 30 * test::more(); ++seed) {
    Random random(seed, 49);
    const double scale = std::pow(10.0, random.uniform(-6, 6));
    const TriangleMesh whole =
        test::transformed(turned(any_solid(random), random), scale,
                          scale * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    TriangleMesh bag = noisy(whole, 3e-7 * radius_of(whole), random);
    for (Point& p : bag.vertices)
      for (double& x : p) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.6g", x);
        x = std::atof(digits);
      }
    expect_mended(bag, whole, "seed " + std::to_string(seed));
  }
}

// Walls, and gaps between two solids, that are thinner than corners are joined over: what is nearest is joined, and
// then nothing is open.
TEST(JoinedCorners, AreNeverThoseOfAnotherSheet) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 60 * test::more(); ++seed) {
    Random random(seed, 44);
    const double thickness = std::pow(10.0, random.uniform(-9, -4)), noise = thickness * random.uniform(0, 0.01);
    const TriangleMesh plate = box({0, 0, 0}, {1, 1, thickness}),
                       pair = test::joined({box({0, 0, 0}, {1, 1, 1}), box({1 + thickness, 0, 0}, {2, 1, 1})});
    TriangleMesh bag = noisy(plate, noise, random);
    EXPECT_TRUE(repair_mesh(bag).solid) << seed;
    EXPECT_EQ(check_mesh(bag).vertices, 8u) << seed;
    EXPECT_NEAR(check_mesh(bag).volume, thickness, 0.05 * thickness) << seed << " " << thickness;
    bag = noisy(pair, noise, random);
    EXPECT_TRUE(repair_mesh(bag).solid) << seed;
    EXPECT_EQ(check_mesh(bag).vertices, 16u) << seed;
    EXPECT_EQ(check_mesh(bag).components, 2u) << seed << " " << thickness;
  }
}

TEST(JoinedCorners, LeaveHolesToBeFilled) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 20 * test::more(); ++seed) {
    Random random(seed, 45);
    const TriangleMesh ball = turned(test::icosphere(2), random);
    TriangleMesh bag = noisy(ball, 1e-7, random);
    bag.triangles.erase(bag.triangles.begin() + static_cast<std::ptrdiff_t>(random.below(bag.triangles.size())));
    const MeshRepairReport report = repair_mesh(bag);
    EXPECT_TRUE(report.solid) << seed;
    EXPECT_EQ(report.holes_filled, 1u) << seed;
    EXPECT_EQ(report.triangles_added, 1u) << seed;
    EXPECT_EQ(check_mesh(bag).vertices, 162u) << seed;
  }
}

TEST(JoinedCorners, TakeFacetsWithThemThatHaveNoArea) {
  for (std::uint64_t seed = test::first_seed(); seed < test::first_seed() + 20 * test::more(); ++seed) {
    Random random(seed, 46);
    const TriangleMesh whole = any_solid(random);
    TriangleMesh split = whole;
    // An edge's two triangles get one between them whose corners at one end are two.
    const auto [a, b, c] = split.triangles[0];
    split.vertices.push_back(split.vertices[b] + Vector(1e-9, 0, 0));
    const Index twin = static_cast<Index>(split.vertices.size() - 1);
    split.triangles[0] = {a, twin, c};
    split.triangles.push_back({a, b, twin});
    split.triangles.push_back({twin, b, c});
    TriangleMesh mesh = noisy(split, 1e-9, random);
    const MeshRepairReport report = repair_mesh(mesh);
    EXPECT_TRUE(report.solid) << seed << " " << report.faults;
    EXPECT_EQ(report.holes_filled, 0u) << seed;
    EXPECT_NEAR(check_mesh(mesh).volume, check_mesh(whole).volume, 1e-6) << seed;
  }
}

TEST(JoinedCorners, ScaleExactlyByPowersOfTwo) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed, 47);
    const TriangleMesh bag = noisy(any_solid(random), std::pow(10.0, random.uniform(-15, -6)), random);
    TriangleMesh mesh = bag;
    const MeshRepairReport report = repair_mesh(mesh);
    for (const int exponent : {-60, -20, 1, 30}) {
      const double scale = std::ldexp(1.0, exponent);
      TriangleMesh scaled = test::transformed(bag, scale, Vector::Zero());
      const MeshRepairReport scaled_report = repair_mesh(scaled);
      EXPECT_EQ(scaled.triangles, mesh.triangles) << seed;
      EXPECT_EQ(scaled.vertices, test::transformed(mesh, scale, Vector::Zero()).vertices) << seed;
      EXPECT_EQ(scaled_report.max_join, scale * report.max_join) << seed;
    }
  }
}

TEST(JoinedCorners, AreApartWhereThatIsAskedFor) {
  Random random(1, 48);
  const TriangleMesh whole = box({0, 0, 0}, {1, 1, 1});
  TriangleMesh mesh = noisy(whole, 1e-9, random);
  EXPECT_EQ(repair_mesh(mesh, {.join_distance = 0}).vertices_joined, 0u);
  mesh = noisy(whole, 1e-3, random);
  EXPECT_EQ(repair_mesh(mesh, {.join_distance = 1e-2}).holes_filled, 0u);
  EXPECT_EQ(check_mesh(mesh).vertices, 8u);
}

TEST(JoinedCorners, OfTheCasesGiveTheirSolids) {
  const std::filesystem::path folder = std::filesystem::path(ORCHARD_SHARED_MODELS).parent_path() / "cases";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no cases";
  const struct {
    const char* file;
    Index vertices;
    double volume;
  } cases[] = {
      {"zero_noise_cube.stl", 8, 8}, {"zero_noise_bore.stl", 64, 15.234633}, {"featuretype.STL", 1722, 11.627733}};
  for (const auto& [file, vertices, volume] : cases) {
    TriangleMesh mesh = read_mesh(folder / file);
    const MeshRepairReport report = repair_mesh(mesh);
    EXPECT_TRUE(report.solid) << file;
    EXPECT_EQ(report.holes_filled, 0u) << file;
    EXPECT_EQ(mesh.vertices.size(), vertices) << file;
    EXPECT_NEAR(check_mesh(mesh).volume, volume, 1e-6) << file;
  }
}

}  // namespace
}  // namespace orchard
