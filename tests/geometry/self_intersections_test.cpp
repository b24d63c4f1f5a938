#include "orchard/geometry/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orchard/geometry/mesh_details.h"
#include "orchard/geometry/random.h"
#include "support/shapes.h"

namespace orchard {
namespace {

using Pairs = std::vector<std::array<Index, 2>>;
using PointTriangle = std::array<Point, 3>;

TriangleMesh mesh_of(std::initializer_list<PointTriangle> triangles) {
  TriangleMesh mesh;
  for (const PointTriangle& corners : triangles) {
    const Index first = static_cast<Index>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(SelfIntersections, AreFoundWherePairsOfTrianglesMeetBeyondWhatTheyShare) {
  const PointTriangle flat{Point(0, 0, 0), Point(2, 0, 0), Point(0, 2, 0)};
  const struct {
    const char* name;
    PointTriangle other;
    bool meet;
  } cases[] = {
      {"apart", {Point(0, 0, 1), Point(2, 0, 1), Point(0, 2, 1)}, false},
      {"piercing", {Point(.5, .5, -1), Point(.5, .5, 1), Point(3, 3, 0)}, true},
      {"touching with a corner inside", {Point(.5, .5, 0), Point(.5, .5, 1), Point(3, 3, 1)}, true},
      {"touching with a corner on an edge", {Point(1, 0, 0), Point(1, -1, 0), Point(2, -1, 0)}, true},
      {"overlapping in a plane", {Point(.5, .5, 0), Point(3, .5, 0), Point(.5, 3, 0)}, true},
      {"sharing a corner, bent away", {Point(0, 0, 0), Point(-1, 0, 1), Point(0, -1, 1)}, false},
      {"sharing a corner, cutting", {Point(0, 0, 0), Point(2, 2, 1), Point(2, 2, -1)}, true},
      {"sharing a corner, along a whole edge", {Point(0, 0, 0), Point(3, 0, 0), Point(0, -1, 1)}, true},
      {"sharing a corner, beside it in the plane", {Point(0, 0, 0), Point(-1, 0, 0), Point(0, -1, 0)}, false},
      {"sharing an edge", {Point(2, 0, 0), Point(0, 0, 0), Point(0, 0, 1)}, false},
      {"sharing an edge, opposite", {Point(2, 0, 0), Point(0, 0, 0), Point(0, -2, 0)}, false},
      {"sharing an edge, folded over", {Point(2, 0, 0), Point(0, 0, 0), Point(1, 1, 0)}, true},
      {"the same triangle", {Point(0, 0, 0), Point(0, 2, 0), Point(2, 0, 0)}, false},
      {"no area", {Point(.5, .5, -1), Point(.5, .5, 1), Point(.5, .5, 0)}, false},
  };
  for (const auto& [name, other, meet] : cases) {
    const Pairs expected = meet ? Pairs{{0, 1}} : Pairs{};
    EXPECT_EQ(self_intersections(mesh_of({flat, other})), expected) << name;
    EXPECT_EQ(self_intersections(mesh_of({other, flat})), expected) << name << ", the other way round";
  }
}

TEST(SelfIntersections, AreAbsentFromCleanSolids) {
  for (const TriangleMesh& mesh : {test::box(Point(0, 0, 0), Point(1, 1, 1)), test::icosphere(3), test::torus(30, 12),
                                   test::l_shape(), test::u_shape(0.1), test::two_boxes(0.1), test::open_box()})
    EXPECT_TRUE(self_intersections(mesh).empty());
}

// A segment pierces a triangle; coplanar cases do not occur among random triangles.
bool pierces(const Point& from, const Point& to, const PointTriangle& t) {
  const auto volume = [](const Point& a, const Point& b, const Point& c, const Point& d) {
    return (b - a).cross(c - a).dot(d - a);
  };
  if ((volume(t[0], t[1], t[2], from) > 0) == (volume(t[0], t[1], t[2], to) > 0)) return false;
  const bool first = volume(from, to, t[0], t[1]) > 0;
  return (volume(from, to, t[1], t[2]) > 0) == first && (volume(from, to, t[2], t[0]) > 0) == first;
}

TEST(SelfIntersections, AgreeWithAllPairsOfRandomTriangles) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed, 3);
    TriangleMesh mesh;
    for (Index i = 0; i < 120; ++i) {
      const Point base(random.uniform(), random.uniform(), random.uniform());
      mesh.vertices.push_back(base);
      for (int k = 0; k < 2; ++k)
        mesh.vertices.push_back(base +
                                0.4 * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
      mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const auto corners = [&](Index t) -> PointTriangle {
      return {mesh.vertices[3 * t], mesh.vertices[3 * t + 1], mesh.vertices[3 * t + 2]};
    };
    Pairs expected;
    for (Index a = 0; a < 120; ++a)
      for (Index b = a + 1; b < 120; ++b) {
        const PointTriangle p = corners(a), q = corners(b);
        bool meet = false;
        for (std::size_t i = 0; i < 3; ++i)
          meet |= pierces(p[i], p[(i + 1) % 3], q) || pierces(q[i], q[(i + 1) % 3], p);
        if (meet) expected.push_back({a, b});
      }
    EXPECT_EQ(self_intersections(mesh), expected) << "seed " << seed;
  }
}

TEST(MeshDetails, CountsLoopsDuplicatesAndHandles) {
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(1, 1, 1)), torus = test::torus(9, 7);
  const TriangleMesh lone{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const TriangleMesh touching{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, 1, 0}, {0, -1, 1}, {0, -1, 2}},
                              {{0, 1, 2}, {0, 3, 4}, {0, 5, 6}}};
  const struct {
    const char* name;
    TriangleMesh mesh;
    Index loops, duplicates, coincident;
    std::int64_t genus;  // -1: none
  } cases[] = {
      {"box", box, 0, 0, 0, 0},
      {"torus", torus, 0, 0, 0, 1},
      {"two tori", test::joined({torus, test::transformed(torus, 1, Vector(9, 0, 0))}), 0, 0, 0, 2},
      {"open box", test::open_box(), 1, 0, 0, -1},
      {"lone triangle", lone, 1, 0, 0, -1},
      {"three triangles that touch at a vertex", touching, 3, 0, 0, -1},
      {"two boxes side by side", test::two_boxes(0), 0, 2, 4, 0},
      {"box twice", test::joined({box, box}), 0, 12, 8, 0},
  };
  for (const auto& [name, mesh, loops, duplicates, coincident, genus] : cases) {
    const MeshDetails details = mesh_details(mesh, check_mesh(mesh));
    EXPECT_EQ(details.boundary_loops, loops) << name;
    EXPECT_EQ(details.duplicate_triangles, duplicates) << name;
    EXPECT_EQ(details.coincident_vertices, coincident) << name;
    EXPECT_EQ(details.genus.value_or(-1), genus) << name;
  }
}

}  // namespace
}  // namespace orchard
