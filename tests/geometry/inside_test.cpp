#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include "orchard/geometry/error.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/repair.h"
#include "orchard/geometry/surface.h"
#include "orchard/geometry/wrap.h"
#include "support/effort.h"
#include "support/shapes.h"
#include "support/winding_oracle.h"

// What is inside, by brute force: the winding number of a loop over all triangles.
namespace orchard {
namespace {

namespace fs = std::filesystem;

Vector in_cube(Random& random) { return {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}; }

// Folds everywhere: places that the surface surrounds twice, or the wrong way round.
TriangleMesh crumpled(TriangleMesh mesh, double amplitude, std::uint64_t seed) {
  Random random(seed, 21);
  for (Point& p : mesh.vertices) p += amplitude * in_cube(random);
  return mesh;
}

// Boxes with corners on a coarse lattice: they overlap, touch in faces, edges and vertices, coincide, are cavities.
TriangleMesh lattice_boxes(std::uint64_t seed) {
  Random random(seed, 22);
  TriangleMesh mesh;
  const auto count = 2 + random.below(5);
  while (mesh.triangles.size() < 12 * count) {
    Point lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = static_cast<double>(random.below(4));
      upper[axis] = lower[axis] + 1 + static_cast<double>(random.below(3));
    }
    TriangleMesh box = test::box(lower, upper);
    if (random.below(4) == 0) box = test::mirrored(std::move(box));
    TriangleMesh more = test::joined({mesh, box});
    if (check_mesh(more).solid()) mesh = std::move(more);
  }
  return mesh;
}

// Beside triangles that cut each other, or beside any, at distances from a rounding to a part of the size.
std::vector<Point> points_near_folds(const Surface& surface, std::uint64_t count, std::uint64_t seed) {
  const auto& cuts = surface.self_intersections();
  std::vector<Point> points;
  for (std::uint64_t i = 0; i < count; ++i) {
    Random random(seed, 23, i);
    const bool anywhere = cuts.empty() || random.below(8) == 0;
    const Index triangle = anywhere ? static_cast<Index>(random.below(surface.mesh().triangles.size()))
                                    : cuts[random.below(cuts.size())][random.below(2)];
    const auto [a, b, c] = surface.corners(triangle);
    double u = random.uniform(), v = random.uniform(0, 1 - u);
    if (random.below(4) == 0) v = 0;
    if (random.below(4) == 0) u = 0;
    const double away = surface.bounding_radius() * std::pow(10, random.uniform(-9, -0.3));
    points.emplace_back(a + u * (b - a) + v * (c - a) + away * in_cube(random));
  }
  return points;
}

struct Tally {
  std::uint64_t asked = 0, inside = 0, unclear = 0;
};

// Points nearer to the surface than rounding lets anyone tell are left out.
void compare(const Surface& surface, const std::vector<Point>& points, const std::string& name, Tally& tally) {
  const test::WindingOracle oracle(surface.mesh());
  const Box& box = surface.bounding_box();
  const double rounding = 1e-12 * box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  for (const Point& point : points) {
    const double distance = surface.signed_distance(point);
    ASSERT_EQ(std::abs(distance), surface.distance(point)) << name;
    if (std::abs(distance) <= rounding) continue;
    const std::optional<int> winding = oracle.winding(point);
    ++tally.asked;
    tally.unclear += !winding;
    if (!winding) continue;
    tally.inside += *winding > 0;
    ASSERT_EQ(distance<0, *winding> 0) << name << " at " << point.transpose() << ", winding number " << *winding;
    ASSERT_EQ(surface.winding_number(point), *winding) << name << " at " << point.transpose();
  }
}

void expect_both_sides(const Tally& tally) {
  EXPECT_GT(tally.inside, tally.asked / 50);
  EXPECT_LT(tally.inside, tally.asked - tally.asked / 20);
  EXPECT_LT(tally.unclear, tally.asked / 100);
}

TEST(Inside, IsWhereACrumpledSurfaceWindsAround) {
  Tally tally;
  for (std::uint64_t i = 0; i < 12 * test::more(); ++i) {
    const std::uint64_t seed = test::first_seed() + i;
    const double amplitude = 0.05 * static_cast<double>(1 + seed % 6);
    TriangleMesh mesh = crumpled(seed % 2 == 0 ? test::icosphere(3) : test::torus(30, 14), amplitude, seed);
    if (seed % 3 == 0) mesh = test::transformed(std::move(mesh), 1, Vector(1e5, -2e5, 3e4));
    const Surface surface(std::move(mesh));
    if (!surface.solid()) continue;
    compare(surface, points_near_folds(surface, 1000, seed), "seed " + std::to_string(seed), tally);
  }
  EXPECT_GT(tally.asked, 9000u);
  expect_both_sides(tally);
}

// Rays from points of the lattice run along faces, through edges and vertices.
TEST(Inside, IsWhereBoxesOnALatticeWindAround) {
  Tally tally;
  for (std::uint64_t i = 0; i < 60 * test::more(); ++i) {
    const std::uint64_t seed = test::first_seed() + i;
    const Surface surface(lattice_boxes(seed));
    std::vector<Point> points;
    for (int k = 0; k < 13 * 13 * 13; k += 4) {
      const int x = k % 13, y = k / 13 % 13, z = k / 169;
      points.emplace_back(0.5 * x, 0.5 * y, 0.5 * z);
    }
    compare(surface, points, "seed " + std::to_string(seed), tally);
  }
  expect_both_sides(tally);
}

// Needs the winding number: pseudonormals call the shell between the two outside, and the overlap a matter of luck.
TEST(Inside, IsWhatIsSurroundedHoweverOften) {
  const Surface nested(test::joined({test::icosphere(2, 2), test::icosphere(2, 1)}));
  ASSERT_TRUE(nested.solid());
  EXPECT_TRUE(nested.self_intersections().empty());
  EXPECT_EQ(nested.winding_number({0, 0, 0}), 2);
  EXPECT_EQ(nested.winding_number({0, 0, 1.1}), 1);
  EXPECT_LT(nested.signed_distance({0, 0, 1.1}), 0);
  EXPECT_LT(nested.signed_distance({0, 0, 0.5}), 0);
  EXPECT_GT(nested.signed_distance({0, 0, 2.5}), 0);

  const Surface hollow(test::joined({test::icosphere(2, 2), test::mirrored(test::icosphere(2, 1))}));
  EXPECT_EQ(hollow.winding_number({0, 0, 0}), 0);
  EXPECT_GT(hollow.signed_distance({0, 0, 0.5}), 0);
  EXPECT_LT(hollow.signed_distance({0, 0, 1.1}), 0);
}

TEST(Inside, DoesNotDependOnTheOrderOfQueriesOrThreads) {
  const Surface surface(crumpled(test::icosphere(3), 0.2, 5)), other(surface.mesh());
  const std::vector<Point> points = points_near_folds(surface, 2000, 6);
  for (const Point& point : points) (void)surface.signed_distance(point);
  for (std::size_t i = points.size(); i-- > 0;)
    ASSERT_EQ(other.signed_distance(points[i]), surface.signed_distance(points[i])) << i;
}

TEST(Inside, NeedsAClosedSurface) {
  const Surface open(test::open_box());
  EXPECT_THROW((void)open.winding_number({0, 0, 0}), InputError);
  EXPECT_THROW((void)open.signed_distance({0, 0, 0}), InputError);
}

const fs::path kModels = ORCHARD_SHARED_MODELS;

// A point from which a pseudonormal at one of the mesh's folds pointed the wrong way.
TEST(Inside, IsNotAPlaceBesideAFoldOfTheCow) {
  if (!fs::exists(kModels / "dirty/cow-igl.off")) GTEST_SKIP() << "no shared models";
  const Surface surface(read_mesh(kModels / "dirty/cow-igl.off"));
  const Point point(-.502307959977, -.169941029201, .0270489669925);
  EXPECT_EQ(surface.winding_number(point), 0);
  EXPECT_NEAR(surface.signed_distance(point), .0452 * surface.bounding_radius(), 1e-4 * surface.bounding_radius());
}

// As read, repaired, or wrapped: each of the shared models that is a solid then. Few are wrapped but in long runs.
TEST(Inside, IsWhereTheSharedModelsWindAround) {
  if (!fs::exists(kModels)) GTEST_SKIP() << "no shared models";
  Tally tally;
  std::vector<fs::path> files;
  for (const char* folder : {"dirty", "robot"})
    for (const auto& entry : fs::directory_iterator(kModels / folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    TriangleMesh mesh;
    try {
      mesh = read_mesh(file);
    } catch (const InputError&) {
      continue;  // a file of another kind, or one that holds more than triangles
    }
    if (test::more() == 1 && mesh.triangles.size() > 10'000) continue;
    const bool wrapped = !repair_mesh(mesh).solid;
    if (wrapped && test::more() == 1 && mesh.triangles.size() > 1000) continue;
    if (wrapped) mesh = wrap_mesh(mesh, {.alpha = test::more() == 1 ? 0.1 : 0.01});
    const Surface surface(std::move(mesh));
    ASSERT_TRUE(surface.solid()) << file;
    compare(surface, points_near_folds(surface, 400 * test::more(), test::first_seed() + 31), file, tally);
    if (test::more() > 1)
      std::printf("%s%s: %zu triangles, %zu cuts, %llu points asked so far\n", file.c_str(), wrapped ? " wrapped" : "",
                  surface.mesh().triangles.size(), surface.self_intersections().size(),
                  static_cast<unsigned long long>(tally.asked));
  }
  expect_both_sides(tally);
}

}  // namespace
}  // namespace orchard
