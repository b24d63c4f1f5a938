#include <gtest/gtest.h>

#include <cmath>

#include "canonical_frame.h"
#include "orchard/spheretree/build.h"
#include "orchard/spheretree/octree.h"
#include "support.h"
#include "support/effort.h"

namespace orchard {
namespace {

using namespace test;

AnnealingOptions few_temperatures() {
  AnnealingOptions options = annealing_options(Effort::low);
  options.depth = 2;
  options.iterations = options.iterations_first = 2;
  return options;
}

SphereTreeOptions small_tree(TreeMethod method) {
  SphereTreeOptions options{.axis = false};
  if (method == TreeMethod::tightened) options.tree = TightenOptions{.depth = 2, .effort = Effort::low};
  if (method == TreeMethod::octree) options.tree = OctreeOptions{.depth = 2};
  if (method == TreeMethod::merging) options.tree = MergeOptions{.depth = 2};
  if (method == TreeMethod::annealing) options.tree = few_temperatures();
  options.medial.sampling.face_points = 500;
  options.medial.sampling.edge_points = 100;
  options.samples_by_need = false;
  return options;
}

// A round body with bumps, whose coordinates are whole numbers of the unit.
TriangleMesh bumpy(std::uint64_t seed, double unit) {
  TriangleMesh mesh = icosphere(1);
  Random random(seed, 3);
  for (Point& vertex : mesh.vertices) {
    vertex *= random.uniform(0.8, 1);
    for (double& x : vertex) x = unit * std::round(x / unit);
  }
  return mesh;
}

struct Frame {
  double factor;
  Vector offset;
};

// Of another size, and up to so many of its sizes away.
Frame any_frame(std::uint64_t seed, double sizes) {
  Random random(seed, 4);
  const double factor = std::pow(10, random.uniform(-6, 6));
  const auto part = [&] { return factor * random.uniform(-sizes, sizes); };
  const double x = part(), y = part(), z = part();
  return {factor, Vector(x, y, z)};
}

void expect_same_but_for_the_frame(const SphereTree& tree, const SphereTree& other, const Frame& frame, double error,
                                   const std::string& name) {
  ASSERT_EQ(tree.nodes.size(), other.nodes.size()) << name;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Sphere &a = tree.nodes[i].sphere, &b = other.nodes[i].sphere;
    ASSERT_EQ(tree.nodes[i].parent, other.nodes[i].parent) << name;
    ASSERT_NEAR(frame.factor * a.radius, b.radius, error * frame.factor) << name;
    ASSERT_LE((frame.factor * a.center + frame.offset - b.center).norm(), error * frame.factor) << name;
  }
}

TEST(EveryFrame, HasTheSameTreeButForTheLastDigits) {
  constexpr double kUnits[] = {1e-3, 0x1p-24, 0x1p-12 / 3, 1e-9};
  for (std::uint64_t seed = first_seed(); seed < first_seed() + 4 * more(); ++seed)
    for (const TreeMethod method : {TreeMethod::tightened, TreeMethod::octree, TreeMethod::annealing}) {
      if (method == TreeMethod::annealing && seed % 4 != 1) continue;  // slow
      const TriangleMesh mesh = bumpy(seed, kUnits[seed % 4]);
      const Frame frame = any_frame(seed, seed % 2 == 0 ? 3 : 50);
      const SphereTreeOptions options = small_tree(method);
      const SphereTreeBuild tree = build_sphere_tree(Surface(mesh), options);
      const SphereTreeBuild other = build_sphere_tree(Surface(transformed(mesh, frame.factor, frame.offset)), options);
      const std::string name = "seed " + std::to_string(seed) + ", method " + std::to_string(static_cast<int>(method));
      expect_same_but_for_the_frame(tree.tree, other.tree, frame, 1e-12, name);
      expect_same_but_for_the_frame(tree.octree, other.octree, frame, 1e-12, name);
    }
}

TEST(EveryFrame, HasTheSameTreeWithAnAxisToo) {
  SphereTreeOptions options = small_tree(TreeMethod::tightened);
  options.axis = true;
  const TriangleMesh mesh = bumpy(5, 1e-6);
  const Frame frame{0.01, Vector(7, -5, 3)};
  const SphereTreeBuild tree = build_sphere_tree(Surface(mesh), options);
  const Surface moved(transformed(mesh, frame.factor, frame.offset));
  const SphereTreeBuild other = build_sphere_tree(moved, options);
  expect_same_but_for_the_frame(tree.tree, other.tree, frame, 1e-11, "with an axis");
  EXPECT_NO_THROW(validate(other.medial->sampling, moved));
}

TEST(EveryFrame, ScalesTreesExactlyByPowersOfTwo) {
  const TriangleMesh mesh = transformed(bumpy(1, 1e-9), 1, Vector(2, 3, 5));
  for (const TreeMethod method : {TreeMethod::tightened, TreeMethod::octree, TreeMethod::annealing}) {
    const SphereTreeBuild tree = build_sphere_tree(Surface(mesh), small_tree(method));
    for (const double factor : {0x1p-20, 1024.0}) {
      const Surface scaled(transformed(mesh, factor, Vector::Zero()));
      const SphereTreeBuild other = build_sphere_tree(scaled, small_tree(method));
      expect_same_but_for_the_frame(tree.tree, other.tree, {factor, Vector::Zero()}, 0, "scaled");
    }
  }
}

TEST(EveryFrame, HasTreesThatHoldTheMeshAsItIsThere) {
  const TriangleMesh mesh = bumpy(2, 1e-9);
  for (const double away : {0.0, 1e3, 1e6, 1e9})
    for (const TreeMethod method : {TreeMethod::tightened, TreeMethod::octree}) {
      const Surface surface(transformed(mesh, 1, Vector(away, -away, away / 3)));
      if (!surface.solid()) continue;
      const SphereTreeBuild build = build_sphere_tree(surface, small_tree(method));
      EXPECT_TRUE(build.certificate.ok()) << away;
      expect_conservative(build.tree, surface, "far away");
    }
}

// Their corners are nearer to each other than any lattice point to the next.
TEST(EveryFrame, HasTreesOfMeshesWhoseTrianglesAreThinnerThanTheLattice) {
  for (const double height : {1e-8, 1e-11}) {
    const TriangleMesh mesh =
        prism({{0, 0}, {1, 0}, {1, 1}, {0.5, 1 + height}, {0, 1}}, {{0, 1, 2}, {0, 2, 4}, {4, 2, 3}});
    const Surface surface(mesh);
    ASSERT_TRUE(surface.solid());
    EXPECT_TRUE(detail::FramedSurface(surface).surface().solid());
    const SphereTreeBuild build = build_sphere_tree(surface, small_tree(TreeMethod::tightened));
    expect_conservative(build.tree, surface, "prism");
    const Frame frame{3, Vector(1, 2, 3)};
    const Surface moved(transformed(mesh, frame.factor, frame.offset));
    if (!moved.solid()) continue;
    const SphereTreeBuild other = build_sphere_tree(moved, small_tree(TreeMethod::tightened));
    expect_conservative(other.tree, moved, "moved prism");
    if (height > 1e-10) expect_same_but_for_the_frame(build.tree, other.tree, frame, 1e-12, "prism");
  }
}

TEST(EveryFrame, TakesPointsInAndOutOnTheirTriangles) {
  const Surface surface(transformed(bumpy(3, 1e-4), 0.3, Vector(40, 2, -1)));
  const detail::FramedSurface framed(surface);
  const SurfaceSampling points = points_of(framed.surface(), 2000);
  const SurfaceSampling out = framed.out(points), in = framed.in(out);
  EXPECT_NO_THROW(validate(out, surface));
  for (Index i = 0; i < points.size(); ++i) EXPECT_LE((points.points[i] - in.points[i]).norm(), 1e-12);
}

TEST(CanonicalFrame, TakesOutBallsThatHoldWhatTheyHeld) {
  Random random(1, 5);
  const auto any_point = [&](const Vector& middle, double size) -> Point {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
    return middle + size * Vector(x, y, z);
  };
  for (const double lattice : {0.0, 0x1p-23, 0x1p-40})
    for (const double away : {0.0, 1.0, 1e6, 1e12})
      for (int k = 0; k < 2000; ++k) {
        const Point middle = any_point(Vector::Zero(), away), low = any_point(middle, 1), high = any_point(middle, 1);
        const Box box(low.cwiseMin(high), low.cwiseMax(high));
        const detail::CanonicalFrame frame(box, lattice);
        const Point point = any_point(box.center(), 0.5 * box.sizes().minCoeff());
        const Sphere ball = frame.out({frame.in(point), 0});
        EXPECT_LE((point - ball.center).norm(), ball.radius) << lattice << ' ' << away;
        EXPECT_LE(ball.radius, box.sizes().maxCoeff() * (lattice + 1e-13) + 1e-15 * away);
      }
}

}  // namespace
}  // namespace orchard
