#include "orchard/runtime/shape_query.h"

#include <gtest/gtest.h>

#include <cmath>

#include "allocation.h"
#include "bodies.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

using Real = long double;

Pose random_pose(Draw& draw) {
  Pose pose = draw.pose(3);
  pose.scale = draw.bits() % 2 == 0 ? 1 : draw.uniform(0.25, 4);
  return pose;
}

Vec near_body(Draw& draw, const PackedSphereTree& tree, const Pose& pose) {
  const SiblingBlock& root = tree.blocks[0];
  Vec p = draw.direction();
  const double at = draw.uniform(0, 1.5) * double{root.radius[0]};
  const Vec middle = {root.x[0], root.y[0], root.z[0]};
  for (std::size_t i = 0; i < 3; ++i) p[i] = at * p[i] + middle[i] + tree.origin[i];
  return transform(pose, p);
}

Real distance_to(const std::vector<Triangle>& placed, const Triangle& shape) {
  return surface_distance({shape}, placed);
}

Triangle flat(const Vec& p, const Vec& q) { return {{{p[0], p[1], p[2]}, {q[0], q[1], q[2]}, {q[0], q[1], q[2]}}}; }

TEST(ShapeQuery, FindsTheNearestPointToAPointAndToASegment) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    Draw draw(seed);
    const Body& body = all[seed % all.size()];
    const Pose pose = random_pose(draw);
    const auto placed = placed_triangles(body.tree, pose);
    const Vec p = near_body(draw, body.tree, pose), q = seed % 2 == 0 ? p : near_body(draw, body.tree, pose);
    const double truth = static_cast<double>(distance_to(placed, flat(p, q)));
    const double rounding =
        1e-6 * (1 + pose.scale);  // of the oracle's parallel edges and of a body far from its origin
    const std::size_t before = allocations;
    const SurfacePoint found = nearest_point_to_segment(body.tree, pose, p, q);
    ASSERT_EQ(allocations, before);
    ASSERT_NEAR(found.distance, truth, rounding) << seed << " " << body.name;
    ASSERT_LE(point_distance({found.point[0], found.point[1], found.point[2]}, placed.at(found.triangle)), 1e-8);
    ASSERT_NE(nearest_point_to_segment(body.tree, pose, p, q, truth + 2 * rounding).triangle, kNoTriangle) << seed;
    if (truth > 4 * rounding) {
      ASSERT_EQ(nearest_point_to_segment(body.tree, pose, p, q, truth - 2 * rounding).triangle, kNoTriangle) << seed;
    }
    if (p == q) {
      ASSERT_EQ(nearest_point(body.tree, pose, p).distance, found.distance);
    }
  }
}

TEST(ShapeQuery, CastsRaysToTheFirstTriangle) {
  const auto all = bodies();
  int hits = 0, misses = 0;
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    Draw draw(seed);
    const Body& body = all[seed % all.size()];
    const Pose pose = random_pose(draw);
    const auto placed = placed_triangles(body.tree, pose);
    const Vec from = near_body(draw, body.tree, pose), to = near_body(draw, body.tree, pose);
    const Vec way = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    const auto hit = cast_ray(body.tree, pose, from, way, 1);
    const Real gap = distance_to(placed, flat(from, to));
    if (!hit) {
      ASSERT_GT(gap, 0) << seed;
      ++misses;
      continue;
    }
    ++hits;
    ASSERT_LT(gap, 1e-9) << seed;
    ASSERT_LE(point_distance({hit->point[0], hit->point[1], hit->point[2]}, placed.at(hit->triangle)), 1e-8) << seed;
    Vec before{};
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_NEAR(hit->point[i], from[i] + hit->along * way[i], 1e-8) << seed;
      before[i] = from[i] + 0.999 * hit->along * way[i];
    }
    if (hit->along > 0.01) {
      ASSERT_GT(distance_to(placed, flat(from, before)), 0) << seed;
    }
    ASSERT_FALSE(cast_ray(body.tree, pose, from, way, 0.99 * hit->along)) << seed;
    ASSERT_TRUE(cast_ray(body.tree, pose, from, way)) << seed;
  }
  EXPECT_GT(hits, 100);
  EXPECT_GT(misses, 50);
}

TEST(ShapeQuery, HitsEdgesAndCornersShotAtExactly) {
  const auto cube = build_tree(box({-1, -1, -1}, {1, 1, 1}), {.leaf_triangles = 1});
  for (const Vec& target : {Vec{1, 1, 1}, Vec{1, 1, 0.25}, Vec{1, 0, 0}, Vec{1, 0.5, 0.5}, Vec{1, -1, 0.5}}) {
    const auto hit = cast_ray(cube, {}, {3, target[1], target[2]}, {-1, 0, 0});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->along, 2);
  }
}

TEST(ShapeQuery, KnowsInsideFromOutsideEvenStraightBelowCornersAndEdges) {
  const auto cube = build_tree(box({-1, -1, -1}, {1, 1, 1}), {.leaf_triangles = 1});
  EXPECT_TRUE(contains(cube, {}, {0, 0, 0}));
  EXPECT_TRUE(contains(cube, {}, {0.5, 0.5, 0.5}));
  EXPECT_FALSE(contains(cube, {}, {1.5, 0, 0}));
  const auto all = bodies();
  int inside = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Draw draw(seed);
    const Body& body = all[seed % 7];  // the closed ones
    const Pose pose = random_pose(draw);
    const Vec p = near_body(draw, body.tree, pose);
    const auto placed = placed_triangles(body.tree, pose);
    Real angle = 0;
    for (const Triangle& t : placed) {
      std::array<std::array<Real, 3>, 3> v{};
      std::array<Real, 3> l{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) v[k][i] = t[k][i] - Real(p[i]);
        l[k] = std::sqrt(v[k][0] * v[k][0] + v[k][1] * v[k][1] + v[k][2] * v[k][2]);
      }
      const auto dot = [&v](std::size_t i, std::size_t j) {
        return v[i][0] * v[j][0] + v[i][1] * v[j][1] + v[i][2] * v[j][2];
      };
      const Real volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                          v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                          v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
      angle += 2 * std::atan2(volume, l[0] * l[1] * l[2] + dot(0, 1) * l[2] + dot(1, 2) * l[0] + dot(2, 0) * l[1]);
    }
    const bool truth = angle > 6;
    ASSERT_EQ(contains(body.tree, pose, p), truth) << seed << " " << body.name;
    inside += truth;
  }
  EXPECT_GT(inside, 50);
}

// As everywhere in orchard: what the surface winds around once or oftener. Parity would leave the overlap out, and
// count what the surface surrounds the wrong way round.
TEST(ShapeQuery, CountsAsInsideWhatIsSurroundedTwiceButNotWhatIsSurroundedInsideOut) {
  const auto joined = [](Mesh mesh, const Mesh& other) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
    return mesh;
  };
  Mesh inside_out = box({4.5, 4.5, 4.5}, {6.5, 6.5, 6.5});
  for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
  const auto tree =
      build_tree(joined(joined(box({0, 0, 0}, {3, 3, 3}), box({1, 1, 1}, {4, 4, 3.5})), inside_out), {.bounds = false});
  int twice = 0, wrong_way = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw draw(seed + 900);
    const bool corners = seed % 4 == 0;  // where many rays meet edges
    Vec p{};
    for (double& x : p) x = corners ? std::floor(draw.uniform(0, 14)) / 2 + 0.25 : draw.uniform(-0.5, 6.5);
    const auto in = [&p](double lower, const Vec& upper) {
      return p[0] > lower && p[1] > lower && p[2] > lower && p[0] < upper[0] && p[1] < upper[1] && p[2] < upper[2];
    };
    const int winding = in(0, {3, 3, 3}) + in(1, {4, 4, 3.5}) - in(4.5, {6.5, 6.5, 6.5});
    ASSERT_EQ(contains(tree, {}, p), winding > 0) << seed;
    twice += winding == 2, wrong_way += winding < 0;
  }
  EXPECT_GT(twice, 5);
  EXPECT_GT(wrong_way, 5);
}

TEST(ShapeQuery, SeesASolidInsideAnother) {
  const auto inner = build_tree(box({-0.1, -0.1, -0.1}, {0.1, 0.1, 0.1})), outer = build_tree(uv_sphere(16, 12, 1));
  EXPECT_TRUE(contains_solid(outer, {}, inner, {}));
  EXPECT_FALSE(contains_solid(inner, {}, outer, {}));
  EXPECT_FALSE(contains_solid(outer, {}, inner, Pose{.translation = {3, 0, 0}}));
}

}  // namespace
}  // namespace orchard::runtime
