#pragma once
#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "orchard/covering/coverage.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/sampling.h"
#include "orchard/geometry/surface.h"
#include "orchard/medial/axis.h"
#include "orchard/spheretree/tree.h"
#include "orchard/voronoi/exact.h"
#include "support/shapes.h"

namespace orchard::test {

inline double ball_volume(double radius) { return 4 * std::numbers::pi / 3 * radius * radius * radius; }

inline SurfaceSampling points_of(const Surface& surface, Index points = 600, std::uint64_t seed = 1) {
  return sample_surface(surface, {.face_points = points, .edge_points = points / 4, .iterations = 10, .seed = seed});
}

inline MedialAxis axis_of(const Surface& surface, Index points = 600, std::uint64_t seed = 1) {
  const SurfaceSampling sampling = points_of(surface, points, seed);
  return medial_axis(surface, sampling, exact_voronoi(sampling.points).diagram);
}

// Points of the surface, corners included.
inline std::vector<Point> points_on(const Surface& surface, int per_triangle, std::uint64_t seed) {
  std::vector<Point> points;
  Random random(seed, 99);
  for (Index i = 0; i < surface.mesh().triangles.size(); ++i) {
    const auto c = surface.corners(i);
    points.insert(points.end(), c.begin(), c.end());
    for (int k = 0; k < per_triangle; ++k) {
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      points.push_back(c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]));
    }
  }
  return points;
}

// Whether the point lies in all balls of some path from the root to a leaf.
inline bool has_path(const SphereTree& tree, const Point& point, Index node = 0) {
  const SphereNode& n = tree.nodes[node];
  if ((point - n.sphere.center).norm() > n.sphere.radius) return false;
  if (n.child_count == 0) return true;
  for (Index child = n.first_child; child < n.first_child + n.child_count; ++child)
    if (has_path(tree, point, child)) return true;
  return false;
}

inline bool same_tree(const SphereTree& a, const SphereTree& b) {
  if (a.nodes.size() != b.nodes.size() || a.branching != b.branching) return false;
  for (std::size_t i = 0; i < a.nodes.size(); ++i) {
    const SphereNode &x = a.nodes[i], &y = b.nodes[i];
    if (x.sphere.center != y.sphere.center || x.sphere.radius != y.sphere.radius || x.parent != y.parent ||
        x.first_child != y.first_child || x.child_count != y.child_count || x.level != y.level ||
        x.center_distance != y.center_distance || x.distance_bound != y.distance_bound || x.inaccuracy != y.inaccuracy)
      return false;
  }
  return true;
}

struct Shape {
  const char* name;
  TriangleMesh mesh;
};

inline std::vector<Shape> shapes() {
  return {{"box", box(Point(0, 0, 0), Point(1, 2, 3))},
          {"icosphere", icosphere(2)},
          {"torus", torus(24, 12)},
          {"L", l_shape()},
          {"U", u_shape(0.3)},
          {"two boxes", two_boxes(0.2)},
          {"far away", transformed(l_shape(), 1, Vector(1e6, -1e6, 1e6))},
          {"tiny", transformed(torus(16, 8), 1e-6, Vector::Zero())}};
}

inline void expect_conservative(const SphereTree& tree, const Surface& surface, const char* name) {
  ASSERT_NO_THROW(validate(tree)) << name;
  EXPECT_TRUE(surface_coverage(surface, path_balls(tree)).complete()) << name;
  for (const Point& point : points_on(surface, 20, 1)) ASSERT_TRUE(has_path(tree, point)) << name;
}

}  // namespace orchard::test
