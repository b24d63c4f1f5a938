#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "collision/kernels/node_box.h"  // private
#include "orchard/runtime/collide.h"
#include "orchard/runtime/packed_tree.h"
#include "support.h"
#include "support/effort.h"

// Bodies beside walls and floors made of a few large triangles, however much larger these are.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

constexpr std::array<double, 6> kSizes = {3, 30, 180, 3e3, 4e4, 1e6};  // half lengths in radii of the body

// A body near a face of a box, in any turn of both, `gap` above the face (below 0: in it) along the face's normal.
struct BesideAWall {
  PackedSphereTree wall;
  Pose body, at;
};

BesideAWall beside_a_wall(Draw& draw, const Mesh& mesh, double size, double gap) {
  const Vec half = {size, size * 2 / 3, size / 2};
  BesideAWall scene{box_tree(half), draw.pose(0), draw.pose(draw.uniform(0, 10))};
  const std::size_t axis = draw.bits() % 3;
  const double side = draw.bits() % 2 == 0 ? 1 : -1;
  long double lowest = 1e300L;
  for (const Vec& v : mesh.vertices) {
    long double height = 0;
    for (std::size_t i = 0; i < 3; ++i) height += static_cast<long double>(scene.body.rotation[3 * axis + i]) * v[i];
    lowest = std::min(lowest, side * height);
  }
  for (std::size_t i = 0; i < 3; ++i) scene.body.translation[i] = draw.uniform(-1, 1) * std::max(0.0, half[i] - 2.5);
  const long double face = scene.wall.vertices[7][axis];  // as it is stored
  scene.body.translation[axis] = static_cast<double>(side * (face + gap - lowest));
  scene.body = compose(scene.at, scene.body);
  return scene;
}

TEST(Walls, AreTouchedWhereTheLowestCornerReachesThem) {
  const Mesh mesh = uv_sphere(16, 12, 1);
  const auto tree = build_tree(mesh, {.bounds = false});
  const PreparedTree body(tree);
  Workspace workspace;
  const std::uint64_t scenes = 1000 * orchard::test::more();
  for (std::uint64_t i = 0; i < scenes; ++i) {
    Draw draw(orchard::test::first_seed() + i);
    const double size = kSizes[i % kSizes.size()];
    // Beyond what double loses of places so far out, and what floats lose of the corners.
    const double fine = 1e-6 + 1e-13 * size,
                 gap = (i % 2 == 0 ? 1 : -1) * draw.uniform(fine, i % 3 == 0 ? 10 * fine : 1);
    const BesideAWall scene = beside_a_wall(draw, mesh, size, gap);
    const PreparedTree wall(scene.wall);
    const TreePair pair = i % 4 < 2 ? TreePair(body, wall) : TreePair(wall, body);
    const Pose &first = i % 4 < 2 ? scene.body : scene.at, &second = i % 4 < 2 ? scene.at : scene.body;
    ASSERT_EQ(collide(workspace, pair, first, second).answer, gap > 0 ? Answer::no : Answer::yes)
        << "size " << size << " gap " << gap << " case " << i;
  }
}

// Tests are counted, not timed: the same on every machine. All triangles of both are some 20,000.
TEST(Walls, AreAnsweredByAFewTestsAtEverySize) {
  const Mesh mesh = uv_sphere(40, 18, 1);
  const auto tree = build_tree(mesh, {.bounds = false});
  const PreparedTree body(tree);
  Workspace workspace;
  for (const double size : kSizes) {
    for (const double gap : {0.3, 0.01, -0.01, -0.5}) {
      std::uint64_t work = 0;
      constexpr std::uint64_t kScenes = 40;
      for (std::uint64_t seed = 0; seed < kScenes; ++seed) {
        Draw draw(seed);
        const BesideAWall scene = beside_a_wall(draw, mesh, size, gap);
        const PreparedTree wall(scene.wall);
        work += collide(workspace, TreePair(body, wall), scene.body, scene.at).work;
      }
      EXPECT_LE(work, 500 * kScenes) << "size " << size << " gap " << gap;
    }
  }
}

// In any turn of the mesh against its own coordinates.
TEST(Walls, HaveAFlatLeafForEachFaceOfABox) {
  for (std::uint64_t seed = 0; seed < 1000 * orchard::test::more(); ++seed) {
    Draw draw(seed);
    const bool cube = seed % 5 == 0;
    const Vec half = {1, cube ? 1 : draw.uniform(0.05, 1), cube ? 1 : draw.uniform(0.05, 1)};
    Mesh mesh = box({-half[0], -half[1], -half[2]}, half);
    const Pose turn = seed % 3 == 0 ? Pose{} : draw.pose(0);
    for (Vec& v : mesh.vertices) v = transform(turn, v);
    const PackedSphereTree tree = build_tree(mesh, {.bounds = false});
    ASSERT_EQ(tree.triangle_blocks.size(), 6u) << seed;
    for (const ObbNodeBlock& block : tree.obb_nodes) {
      for (std::size_t lane = 0; lane < kBlockWidth && block.radius[lane] >= 0; ++lane) {
        if ((block.child[lane] & kLeafBit) == 0) continue;
        ASSERT_LE(block.height[lane], 1e-6f * block.radius[lane]) << seed;
      }
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
