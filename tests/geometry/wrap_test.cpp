#include "orchard/geometry/wrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"
#include "orchard/geometry/surface_distance.h"
#include "support/shapes.h"

namespace orchard {
namespace {

double diagonal(const TriangleMesh& mesh) {
  Box box;
  for (const Point& vertex : mesh.vertices) box.extend(vertex);
  return box.diagonal().norm();
}

struct Case {
  const char* name;
  TriangleMesh mesh;
};

std::vector<Case> dirty_meshes() {
  TriangleMesh holed = test::icosphere(3), turned = test::icosphere(2),
               walled = test::box(Point(0, 0, 0), Point(1, 1, 1));
  holed.triangles.resize(holed.triangles.size() - 9);
  for (std::size_t t = 0; t < turned.triangles.size(); t += 3)
    std::swap(turned.triangles[t][0], turned.triangles[t][1]);
  walled.triangles.insert(walled.triangles.end(), {{0, 4, 7}, {0, 7, 3}, {3, 3, 3}});
  return {
      {"open", test::open_box()},
      {"with a small hole", holed},
      {"inside out", test::mirrored(test::l_shape())},
      {"triangles turned round", turned},
      {"a wall inside and a degenerate triangle", walled},
      {"parts that cut each other",
       test::joined({test::icosphere(2), test::transformed(test::torus(20, 9), 1, Vector(0.3, 0, 0))})},
      {"parts apart", test::two_boxes(0.4)},
      {"a shell in a shell", test::joined({test::icosphere(2), test::icosphere(2, 0.5)})},
      {"a lone triangle", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}},
      {"far from the origin", test::transformed(test::open_box(), 1, Vector(1e4, 0, -1e4))},
      {"tiny", test::transformed(test::open_box(), 1e-6, Vector::Zero())},
  };
}

constexpr WrapOptions kCoarse{.alpha = 1.0 / 20, .offset = 1.0 / 100};

TEST(WrapMesh, EnclosesAnyTrianglesInASolid) {
  for (const auto& [name, mesh] : dirty_meshes()) {
    const Surface wrap(wrap_mesh(mesh, kCoarse)), input(mesh);
    ASSERT_TRUE(wrap.solid()) << name << ": " << wrap.report().faults();
    Random random(1, 0);
    for (Index t = 0; t < mesh.triangles.size(); ++t) {
      const auto corners = input.corners(t);
      for (int i = 0; i < 4; ++i) {
        double u = random.uniform(), v = random.uniform();
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Point p = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
        EXPECT_LT(wrap.signed_distance(p), 0) << name;
      }
      for (const Point& corner : corners) EXPECT_LT(wrap.signed_distance(corner), 0) << name;
    }
  }
}

TEST(WrapMesh, StaysAsCloseAsItsOptionsSay) {
  for (const auto& [name, mesh] : dirty_meshes()) {
    const Surface wrap(wrap_mesh(mesh, kCoarse)), input(mesh);
    const double length = diagonal(mesh);
    EXPECT_LE(surface_distance(wrap, input).upper, (kCoarse.alpha + kCoarse.offset) * length) << name;
  }
}

TEST(WrapMesh, FollowsAConvexShapeAtTheOffset) {
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(1, 1, 1));
  const Surface input(box);
  for (const double offset : {1.0 / 50, 1.0 / 200}) {
    const Surface wrap(wrap_mesh(box, {.alpha = 1.0 / 10, .offset = offset}));
    const double upper = surface_distance(wrap, input).upper / (offset * diagonal(box));
    EXPECT_GT(upper, 0.9) << offset;
    EXPECT_LT(upper, 1.1) << offset;
  }
}

TEST(WrapMesh, ClosesHolesNarrowerThanAlphaOnly) {
  const TriangleMesh open = test::open_box();
  const double volume_closed = check_mesh(wrap_mesh(open, {.alpha = 0.9, .offset = 0.01})).volume;
  const double volume_open = check_mesh(wrap_mesh(open, {.alpha = 0.1, .offset = 0.01})).volume;
  EXPECT_GT(volume_closed, 1);  // the box is full
  EXPECT_LT(volume_open, 0.5);  // the wrap goes inside
}

TEST(WrapMesh, IsTheSameEveryTime) {
  const TriangleMesh mesh = dirty_meshes()[5].mesh;
  const TriangleMesh once = wrap_mesh(mesh, kCoarse), again = wrap_mesh(mesh, kCoarse);
  EXPECT_EQ(once.vertices, again.vertices);
  EXPECT_EQ(once.triangles, again.triangles);
}

TEST(WrapMesh, RefusesWhatItCannotWrap) {
  const TriangleMesh box = test::box(Point(0, 0, 0), Point(1, 1, 1));
  for (const double bad : {0.0, -1.0, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(wrap_mesh(box, {.alpha = bad}), InputError) << bad;
    EXPECT_THROW(wrap_mesh(box, {.offset = bad}), InputError) << bad;
  }
  EXPECT_THROW(wrap_mesh({}, {}), InputError);
  EXPECT_THROW(wrap_mesh({{{1, 2, 3}}, {{0, 0, 0}}}, {}), InputError);
  EXPECT_THROW(wrap_mesh({{{1, 2, 3}}, {{0, 0, 1}}}, {}), InputError);
}

}  // namespace
}  // namespace orchard
