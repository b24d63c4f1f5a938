#include "orchard/runtime/packed_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies.h"
#include "improper_poses.h"
#include "orchard/runtime/collide.h"
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

TEST(ShapeTrees, AreSoundAndHoldTheShapes) {
  const std::vector<Vec> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  for (const PackedSphereTree& tree : {point_tree({5, -3, 1e6}), segment_tree({1, 2, 3}, {4, 5, 6}),
                                       box_tree({1, 1e-6, 30}), triangles_tree(corners, triangles)}) {
    EXPECT_EQ(structure_fault(tree), nullptr);
  }
  const auto tetrahedron = triangles_tree(corners, triangles);
  EXPECT_TRUE(contains(tetrahedron, {}, {0.1, 0.1, 0.1}));
  EXPECT_FALSE(contains(tetrahedron, {}, {0.5, 0.5, 0.5}));
  EXPECT_NEAR(nearest_point(point_tree({1, 2, 3}), {}, {1, 2, 5}).distance, 2, 1e-12);
  EXPECT_NEAR(nearest_point(segment_tree({0, 0, 0}, {1, 0, 0}), {}, {0.5, 3, 4}).distance, 5, 1e-12);
  EXPECT_TRUE(contains(box_tree({1, 2, 3}), {}, {0.9, -1.9, 2.9}));
  EXPECT_FALSE(contains(box_tree({1, 2, 3}), {}, {1.1, 0, 0}));
}

// Everything is inside, corners are of the given points, edges have two sides, every edge is convex.
TEST(ShapeTrees, HullsAreConvexAndHoldEveryPoint) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Draw draw(seed);
    std::vector<Vec> points;
    const int count = 4 + static_cast<int>(draw.bits() % 60);
    for (int i = 0; i < count; ++i) {
      Vec p = {draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(-1, 1)};
      if (seed % 3 == 1) {
        for (double& x : p) x = std::round(2 * x);  // many in one plane or line, many twice
      }
      if (seed % 3 == 2) p = draw.direction();
      points.push_back(p);
    }
    const auto hull = hull_tree(points);
    if (!hull) {
      ASSERT_EQ(seed % 3, 1u) << seed;
      continue;
    }
    ASSERT_EQ(structure_fault(*hull), nullptr) << seed;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges, reversed;
    for (const auto& t : hull->triangles) {
      std::array<Vec, 3> v{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) v[k][i] = double{hull->vertices[t[k]][i]} + hull->origin[i];
        edges.emplace_back(t[k], t[(k + 1) % 3]);
        reversed.emplace_back(t[(k + 1) % 3], t[k]);
      }
      Vec n{};
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = (v[1][j] - v[0][j]) * (v[2][k] - v[0][k]) - (v[1][k] - v[0][k]) * (v[2][j] - v[0][j]);
      }
      const double size = std::hypot(n[0], n[1], n[2]);
      ASSERT_GT(size, 0) << seed;
      for (const Vec& p : points) {
        const double height = (n[0] * (p[0] - v[0][0]) + n[1] * (p[1] - v[0][1]) + n[2] * (p[2] - v[0][2])) / size;
        ASSERT_LE(height, size > 1e-3 ? 1e-5 : 1e-2) << seed;  // the stored corners are floats
      }
    }
    std::sort(edges.begin(), edges.end()), std::sort(reversed.begin(), reversed.end());
    ASSERT_EQ(edges, reversed) << seed;
    ASSERT_EQ(std::adjacent_find(edges.begin(), edges.end()), edges.end()) << seed;
  }
  EXPECT_FALSE(hull_tree(std::vector<Vec>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.3, 0.7, 0}}));
  EXPECT_FALSE(hull_tree(std::vector<Vec>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}));
  EXPECT_FALSE(hull_tree(std::vector<Vec>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, std::nan("")}}));
  EXPECT_FALSE(hull_tree({}));
}

bool inside_box(const Vec& half, const Pose& pose, const std::array<long double, 3>& p) {
  const Vec local = transform(inverse(pose), {double(p[0]), double(p[1]), double(p[2])});
  return std::fabs(local[0]) <= half[0] && std::fabs(local[1]) <= half[1] && std::fabs(local[2]) <= half[2];
}

TEST(ShapeQuery, TellsWhetherABoxTouchesByBruteForce) {
  const auto all = bodies();
  int yes = 0, no = 0, around = 0;
  for (std::uint64_t seed = 0; seed < 700; ++seed) {
    Draw draw(seed);
    const Body& body = all[seed % all.size()];
    Pose pose = draw.pose(2), box_pose = draw.pose(draw.uniform(0, 1.4) * body.tree.bounding_radius);
    pose.scale = seed % 3 == 0 ? 0.5 : 1;
    pose = centered(body.tree, pose);
    const double size = seed % 7 == 0 ? 3 : 0.4;
    const Vec half = {draw.uniform(0.1, 1) * size, draw.uniform(0.1, 1) * size, draw.uniform(0.1, 1) * size};
    const auto placed = placed_triangles(body.tree, pose);
    const auto box_placed = placed_triangles(box_tree(half), box_pose);
    const bool surfaces = surfaces_intersect(placed, box_placed);
    bool inside = false;
    for (const Triangle& t : placed) inside = inside || inside_box(half, box_pose, t[0]);
    const ShapeContact found = touches_box(body.tree, pose, half, box_pose);
    ASSERT_EQ(found.answer, surfaces || inside ? Answer::yes : Answer::no) << seed << " " << body.name;
    (found.answer == Answer::yes ? yes : no) += 1;
    around += inside && !surfaces;
  }
  EXPECT_GT(yes, 50);
  EXPECT_GT(no, 100);
  EXPECT_GT(around, 3);
}

TEST(ShapeQuery, FindsWhatReachesDeepestBelowAPlane) {
  const auto all = bodies();
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Draw draw(seed);
    const Body& body = all[seed % all.size()];
    Pose pose = draw.pose(3);
    pose.scale = seed % 4 == 0 ? 2.5 : 1;
    const Vec n = draw.direction();
    const double length = draw.uniform(0.1, 10), offset = draw.uniform(-3, 3);
    const Vec normal = {length * n[0], length * n[1], length * n[2]};
    long double least = 1e300L;
    for (const Triangle& t : placed_triangles(body.tree, pose)) {
      for (const auto& p : t) least = std::min(least, p[0] * normal[0] + p[1] * normal[1] + p[2] * normal[2]);
    }
    const auto truth = static_cast<double>((least - offset) / length);
    const SurfacePoint found = deepest_point(body.tree, pose, normal, offset);
    ASSERT_NEAR(found.distance, truth, 1e-11 * (3000 * pose.scale + 10)) << seed << " " << body.name;
    ASSERT_LE(point_distance({found.point[0], found.point[1], found.point[2]},
                             placed_triangles(body.tree, pose).at(found.triangle)),
              1e-8)
        << seed;
  }
}

TEST(ShapeQuery, TellsWhetherHullsTouchLikeTheirTrees) {
  const auto all = bodies();
  int yes = 0, no = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    std::vector<Vec> points;
    for (int i = 0; i < 12; ++i) {
      Vec p = draw.direction();
      for (double& x : p) x *= 0.5;
      points.push_back(p);
    }
    const auto hull = hull_tree(points);
    ASSERT_TRUE(hull);
    std::vector<Vec> corners;
    for (const auto& v : hull->vertices) {
      corners.push_back(
          {double{v[0]} + hull->origin[0], double{v[1]} + hull->origin[1], double{v[2]} + hull->origin[2]});
    }
    const Body& body = all[seed % 7];
    const Pose pose = centered(body.tree, draw.pose(0)),
               at = draw.pose(draw.uniform(0.3, 1.6) * body.tree.bounding_radius);
    const bool truth = surfaces_intersect(placed_triangles(body.tree, pose), placed_triangles(*hull, at));
    const ShapeContact found = touches_convex(body.tree, pose, {corners, hull->triangles}, at);
    const PreparedTree a(body.tree), b(*hull);
    Workspace workspace;
    ASSERT_EQ(collide(workspace, TreePair(a, b), pose, at).answer, truth ? Answer::yes : Answer::no) << seed;
    if (truth) {
      ASSERT_EQ(found.answer, Answer::yes) << seed;
    }
    (found.answer == Answer::yes ? yes : no) += 1;
  }
  EXPECT_GT(yes, 30);
  EXPECT_GT(no, 30);
}

TEST(ShapeQuery, IsUnsureOfImproperShapes) {
  const auto tree = box_tree({1, 1, 1});
  for (const auto& [name, pose] : improper_poses(Draw(1).pose(5))) {
    SCOPED_TRACE(name);
    EXPECT_EQ(touches_box(tree, {}, {1, 1, 1}, pose).answer, Answer::maybe);
    EXPECT_EQ(touches_box(tree, pose, {1, 1, 1}, {}).answer, Answer::maybe);
    EXPECT_LT(deepest_point(tree, pose, {1, 0, 0}, -100).distance, -1e300);
  }
  EXPECT_EQ(touches_box(tree, {}, {1, 0, 1}, {}).answer, Answer::maybe);
  EXPECT_EQ(touches_box(tree, {}, {1, std::nan(""), 1}, {}).answer, Answer::maybe);
  EXPECT_LT(deepest_point(tree, {}, {0, 0, 0}, -100).distance, -1e300);
  EXPECT_EQ(deepest_point(tree, {}, {0, 0, 0}, -100).triangle, kNoTriangle);
  const std::vector<Vec> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> beyond = {{0, 1, 3}};
  EXPECT_EQ(touches_convex(tree, {}, {corners, beyond}, {}).answer, Answer::maybe);
}

TEST(ShapeQuery, CastsManyRaysAsItCastsEach) {
  const auto all = bodies();
  for (std::size_t b = 0; b < all.size(); ++b) {
    Draw draw(b);
    Pose pose = draw.pose(3);
    pose.scale = b % 2 == 0 ? 1 : 0.3;
    std::vector<Ray> rays;
    for (int i = 0; i < 100; ++i) {
      Ray ray{draw.pose(6).translation, draw.direction()};
      if (i % 4 != 0) {
        const Vec target = transform(pose, {all[b].tree.origin[0] + draw.uniform(-0.5, 0.5), all[b].tree.origin[1],
                                            all[b].tree.origin[2] + draw.uniform(-0.5, 0.5)});
        for (std::size_t k = 0; k < 3; ++k) ray.direction[k] = target[k] - ray.origin[k];
      }
      if (i % 5 == 0) ray.longest = draw.uniform(0, 2);
      rays.push_back(ray);
    }
    std::vector<std::optional<RayHit>> hits(rays.size());
    cast_rays(all[b].tree, pose, rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto one = cast_ray(all[b].tree, pose, rays[i].origin, rays[i].direction, rays[i].longest);
      ASSERT_EQ(one.has_value(), hits[i].has_value());
      if (one) {
        ASSERT_EQ(one->along, hits[i]->along);
        ASSERT_EQ(one->triangle, hits[i]->triangle);
      }
    }
  }
}

// From far away, and along the surface itself.
TEST(ShapeQuery, CastsRaysFromAfarAndAlongFaces) {
  const auto cube = build_tree(box({-1, -1, -1}, {1, 1, 1}), {.leaf_triangles = 1});
  for (const double far : {10.0, 1e6, 1e15}) {
    const auto hit = cast_ray(cube, {}, {far, 0.25, 0.25}, {-1, 0, 0});
    ASSERT_TRUE(hit) << far;
    EXPECT_NEAR(hit->along, far - 1, 1e-12 * far);
    EXPECT_FALSE(cast_ray(cube, {}, {far, 1.25, 0.25}, {-1, 0, 0})) << far;
  }
  const auto along_face = cast_ray(cube, {}, {3, 1, 0.3}, {-1, 0, 0});
  ASSERT_TRUE(along_face);
  EXPECT_EQ(along_face->along, 2);
  const auto inside_out = cast_ray(cube, {}, {0, 0, 0}, {0, 1e-30, 0});
  ASSERT_TRUE(inside_out);
  EXPECT_DOUBLE_EQ(inside_out->along, 1e30);
  EXPECT_TRUE(cast_ray(cube, {}, {1, 0.5, 0.5}, {0, 0, 0}));
  EXPECT_FALSE(cast_ray(cube, {}, {0.5, 0.5, 0.5}, {0, 0, 0}));
}

}  // namespace
}  // namespace orchard::runtime
