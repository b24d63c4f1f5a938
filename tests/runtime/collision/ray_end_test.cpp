#include <gtest/gtest.h>

#include <cmath>

#include "every_machine.h"
#include "orchard/runtime/pose.h"
#include "orchard/runtime/shape_query.h"
#include "runtime/same_hit.h"
#include "support.h"
#include "support/effort.h"

// Where a ray ends says which hits count, and nothing else.
namespace orchard::runtime {
namespace {

using test::Draw;

struct IndexedBody {
  PackedSphereTree tree;
  RayIndex index;
  explicit IndexedBody(const test::Mesh& mesh) : tree(test::build_tree(mesh)), index(tree) {}
};

// To a vertex, to a point of an edge, or to anywhere, and not as far as there or farther.
Ray ray_at(Draw& draw, const PackedSphereTree& tree, const Pose& pose) {
  const auto vertex = [&] {
    const auto& v = tree.vertices[draw.bits() % tree.vertices.size()];
    return Vec3{v[0] + tree.origin[0], v[1] + tree.origin[1], v[2] + tree.origin[2]};
  };
  const auto& edge = tree.triangles[draw.bits() % tree.triangles.size()];
  Vec3 at = vertex();
  if (draw.bits() % 3 == 0) {
    const auto &a = tree.vertices[edge[0]], &b = tree.vertices[edge[1]];
    for (std::size_t i = 0; i < 3; ++i) at[i] = 0.5 * (double{a[i]} + double{b[i]}) + tree.origin[i];
  } else if (draw.bits() % 3 == 0) {
    at = draw.uniform(0, 1) * Vec3(draw.direction());
  }
  const Vec3 to = transform(pose, at);
  Ray ray;
  ray.origin = Vec3(pose.translation) + pose.scale * draw.uniform(0, 6) * Vec3(draw.direction());
  ray.direction = std::pow(2, draw.uniform(-20, 20)) * (to - Vec3(ray.origin));
  return ray;
}

void expect_no_bend(Draw& draw, const IndexedBody& body, const Pose& pose, const Ray& ray, std::uint64_t seed,
                    std::size_t& hits) {
  const auto cast = [&](double longest) {
    const auto hit = cast_ray(body.tree, pose, ray.origin, ray.direction, longest);
    Ray ends = ray;
    ends.longest = longest;
    std::array<Ray, 8> rays;
    rays.fill(ends);
    std::array<std::optional<RayHit>, 8> all;
    cast_rays(body.index, pose, rays, all);
    EXPECT_TRUE(test::same_hit(hit, cast_ray(body.index, pose, ray.origin, ray.direction, longest))) << seed;
    EXPECT_TRUE(test::same_hit(hit, all[0]) && test::same_hit(hit, all[7])) << seed;
    return hit;
  };
  const auto hit = cast(std::numeric_limits<double>::infinity());
  if (!hit) return;
  ++hits;
  const double along = hit->along;
  for (const double longest : {along, std::nextafter(along, 1e300), along * (1 + 1e-12), along * 1.000001, along * 1.01,
                               along * 1.1, along * draw.uniform(1, 3), along * 1e6}) {
    ASSERT_TRUE(test::same_hit(cast(longest), hit)) << "seed " << seed << ", " << longest / along;
  }
  const double nearest = length(Vec3(hit->point) - Vec3(pose.translation)) + length(Vec3(ray.origin));
  const double rounding = 1e-11 * nearest / length(Vec3(ray.direction));
  if (!(along > 4 * rounding)) return;
  ASSERT_FALSE(cast(along - 2 * rounding)) << seed;
  ASSERT_FALSE(cast(0.5 * along)) << seed;
}

TEST(RayEnds, BeyondAHitDoNotChangeIt) {
  const IndexedBody bodies[] = {IndexedBody(test::box({-1, -1, -1}, {1, 1, 1})),
                                IndexedBody(test::torus(14, 6, 1, 0.3)), IndexedBody(test::spikes(3, 12, 8)),
                                IndexedBody(test::l_shape())};
  const std::uint64_t begin = orchard::test::first_seed();
  test::on_every_machine([&] {
    std::size_t hits = 0;
    for (std::uint64_t seed = begin; seed < begin + 100 * orchard::test::more(); ++seed) {
      Draw draw(seed);
      for (const IndexedBody& body : bodies) {
        Pose pose = draw.pose(draw.uniform(0, 3));
        if (seed % 3 == 0) pose = {};
        if (seed % 4 == 0) pose.scale = draw.uniform(0.1, 10);
        expect_no_bend(draw, body, pose, ray_at(draw, body.tree, pose), seed, hits);
        if (testing::Test::HasFatalFailure()) return;
      }
    }
    EXPECT_GT(hits, 200u);
  });
}

TEST(RayEnds, OnTheSurfaceCount) {
  const IndexedBody cube(test::box({-1, -1, -1}, {1, 1, 1}));
  for (const double x : {0.0, 0.25, 1.0}) {
    const auto hit = cast_ray(cube.tree, {}, {x, 0.5, 3}, {0, 0, -1}, 2);
    ASSERT_TRUE(hit) << x;
    EXPECT_EQ(hit->along, 2);
    EXPECT_FALSE(cast_ray(cube.tree, {}, {x, 0.5, 3}, {0, 0, -1}, std::nextafter(2, 0)));
    EXPECT_TRUE(cast_ray(cube.tree, {}, {x, 0.5, 1}, {0, 0, -1}, 0));
    EXPECT_FALSE(cast_ray(cube.tree, {}, {x, 0.5, std::nextafter(1, 2)}, {0, 0, -1}, 0));
  }
}

}  // namespace
}  // namespace orchard::runtime
