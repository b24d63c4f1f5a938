// Local thickness against a search over all triangles, on solids that are unlike each other.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/medial/thickness.h"
#include "support/shapes.h"

namespace orchard {
namespace {

constexpr double kSmooth = 0.02;  // radians: next to nothing of what is in front of a place is left out

TriangleMesh uneven(TriangleMesh mesh, double size) {
  for (Index i = 0; i < mesh.vertices.size(); ++i) {
    Random random(7, 1, i);
    for (int k = 0; k < 3; ++k) mesh.vertices[i][k] += size * (random.uniform() - 0.5);
  }
  return mesh;
}

std::vector<std::pair<std::string, TriangleMesh>> solids() {
  using namespace test;
  const std::string data = ORCHARD_DATA_DIR;
  return {{"box", box(Point(0, 0, 0), Point(2, 3, 1))},
          {"plate", box(Point(0, 0, 0), Point(2, 3, 0.01))},
          {"icosahedron", icosphere(0)},
          {"sphere", icosphere(3)},
          {"uneven sphere", uneven(icosphere(3), 0.02)},
          {"torus", torus(40, 20)},
          {"thin torus", torus(60, 10, 1, 0.05)},
          {"uneven torus", uneven(torus(40, 20), 0.01)},
          {"L", l_shape()},
          {"U", u_shape(0.1)},
          {"two boxes", two_boxes(0.01)},
          {"cylinder", turned({{1, 0}, {1, 3}}, 40)},
          {"cone", turned({{1, 0}, {0, 3}}, 24)},
          {"hourglass", turned({{1, 0}, {0.1, 1}, {1, 2}}, 24)},
          {"bottle", turned({{1, 0}, {1, 2}, {0.3, 2.5}, {0.3, 3.5}}, 30)},
          {"shell", joined({icosphere(2), mirrored(icosphere(2, 0.9))})},
          {"far away", transformed(torus(20, 10), 100, Vector(1e4, 0, 0))},
          {"lamp", read_mesh(data + "/lamp.obj")},
          {"faucet", read_mesh(data + "/faucet.obj")},
          {"ship", read_mesh(data + "/ship.obj")}};
}

// The ball ends at a place of this triangle at the latest: shrunk around its nearest place until nothing is nearer.
double shrunk(const Point& p, const Vector& n, const std::array<Point, 3>& corners, double radius) {
  for (int i = 0; i < 200; ++i) {
    const Point center = p - radius * n;
    const ClosestPoint nearest = closest_point_of_triangle(center, corners[0], corners[1], corners[2]);
    if (nearest.distance >= radius * (1 - 1e-14)) return radius;
    const Vector way = p - nearest.position;
    const double next = way.squaredNorm() / (2 * n.dot(way));
    if (!(next < radius)) return radius;
    radius = next;
  }
  return radius;
}

TEST(ThicknessByBruteForce, IsTheSameOnTwentySolids) {
  for (const auto& [name, mesh] : solids()) {
    const Surface surface(mesh);
    std::vector<SurfacePlace> places;
    const Index count = static_cast<Index>(mesh.triangles.size()), step = std::max<Index>(1, count / 40);
    for (Index i = 0; i < count; i += step) {
      const auto [a, b, c] = surface.corners(i);
      places.push_back({0.3 * a + 0.3 * b + 0.4 * c, i, Feature::face});
    }
    const auto found = thickness_at(surface, places, {.smooth = kSmooth, .work = 1'000'000});
    Index compared = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Point& p = places[i].position;
      const Vector& n = found[i].normal;
      double radius = 4 * surface.bounding_radius();
      for (Index k = 0; k < count; ++k)
        if (k != places[i].triangle) radius = shrunk(p, n, surface.corners(k), radius);
      EXPECT_GE(found[i].diameter, 2 * radius * (1 - 1e-9)) << name;
      // Where the smallest ball of all ends at a shallow edge, that of the definition is larger.
      const ClosestPoint nearest = surface.closest(p - radius * n);
      if ((found[i].diameter - 2 * radius) > 1e-9 * radius) {
        EXPECT_LT(nearest.distance, radius * (1 + 1e-9)) << name;
        continue;
      }
      ++compared;
      EXPECT_NEAR(found[i].diameter, 2 * radius, 1e-9 * radius) << name;
    }
    EXPECT_GE(compared, places.size() / 2) << name;
  }
}

}  // namespace
}  // namespace orchard
