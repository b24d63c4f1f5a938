#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "orchard/runtime/contacts.h"
#include "orchard/runtime/packed_tree.h"
#include "orchard/runtime/pose.h"
#include "orchard/runtime/shape_query.h"
#include "orchard/runtime/time_of_impact.h"
#include "support.h"
#include "support/effort.h"

// Places and distances where plain arithmetic has no digits left: planes that nearly are one, needles, normals that
// cancel out.
namespace orchard::runtime {
namespace {

using test::Draw;
using Point = std::array<double, 3>;
using Triangle = std::array<Point, 3>;

constexpr std::array<std::uint32_t, 3> kOne[] = {{0, 1, 2}};

PackedSphereTree tree_of(const Triangle& triangle) { return triangles_tree(triangle, kOne); }

double off(const TreeView& tree, const Pose& pose, const Point& place) {
  return nearest_point(tree, pose, place).distance;
}

TEST(Slivers, HaveCommonPointsOnBothWhereTwoLieInOnePlaneButForRounding) {
  const Triangle corners = {{{1, 0.25, 0.125}, {-0.5, 0.75, 0.5}, {-0.5, -1, -0.625}}};
  const PackedSphereTree tree = tree_of(corners);
  const PreparedTree prepared(tree);
  const TreePair pair(prepared, prepared);
  Workspace workspace;
  Draw draw(1 + orchard::test::first_seed());
  int touching = 0;
  for (std::uint64_t i = 0; i < 2000 * orchard::test::more(); ++i) {
    const Pose a = draw.pose(0);
    Pose b = a;
    const double s = draw.uniform(-1, 1), t = draw.uniform(-1, 1);
    Point by{};
    for (std::size_t k = 0; k < 3; ++k)
      by[k] = s * (corners[1][k] - corners[0][k]) + t * (corners[2][k] - corners[0][k]);
    b.translation = rotate(a, by);
    const Verdict verdict = collide(workspace, pair, a, b);
    if (verdict.answer != Answer::yes) continue;
    ++touching;
    EXPECT_LT(off(tree, a, verdict.contact.center), 1e-12) << i;
    EXPECT_LT(off(tree, b, verdict.contact.center), 1e-12) << i;
    const Distance apart = distance(workspace, pair, a, b);
    EXPECT_LT(off(tree, a, apart.points.on_a), 1e-12) << i;
    EXPECT_LT(off(tree, b, apart.points.on_b), 1e-12) << i;
    const Impact impact = time_of_impact(workspace, pair, {.start = a}, {.start = b});
    EXPECT_LT(off(tree, a, impact.on_a), 1e-12) << i;
  }
  EXPECT_GT(touching, 200);
}

TEST(Slivers, AreHitByRaysInTheirPlanesWhereTheyAre) {
  const Triangle corners = {{{1, 0.25, 0.125}, {-0.5, 0.75, 0.5}, {-0.5, -1, -0.625}}};
  const PackedSphereTree tree = tree_of(corners);
  Draw draw(2 + orchard::test::first_seed());
  int hits = 0;
  for (std::uint64_t i = 0; i < 4000 * orchard::test::more(); ++i) {
    const Pose pose = draw.pose(0);
    const auto place = [&] {
      const double s = draw.uniform(0, 1), t = draw.uniform(0, 1 - s);
      Point at{};
      for (std::size_t k = 0; k < 3; ++k)
        at[k] = corners[0][k] + s * (corners[1][k] - corners[0][k]) + t * (corners[2][k] - corners[0][k]);
      return transform(pose, at);
    };
    const Point from = place(), to = place();
    const SurfacePoint near = nearest_point_to_segment(tree, pose, from, to);
    EXPECT_LT(near.distance, 1e-12);
    EXPECT_LT(off(tree, pose, near.point), 1e-12) << i;
    const std::optional<RayHit> hit = cast_ray(tree, pose, from, Vec3(to) - Vec3(from));
    if (!hit) continue;
    ++hits;
    EXPECT_LT(off(tree, pose, hit->point), 1e-12) << i;
  }
  EXPECT_GT(hits, 100);
}

TEST(Slivers, HaveContactPointsWithinTheirTips) {
  Workspace workspace;
  for (const double width : {0x1p-12, 0x1p-17, 0x1p-20, 0x1p-23}) {
    const double beyond = 0x1p-34 / width;
    const PackedSphereTree a = tree_of({{{0, 0, 0}, {1, 0, 0}, {1, width, 0}}}),
                           b = tree_of({{{-beyond, 0, 0}, {0.5, 0, 0}, {0, 0, -1}}});
    const PreparedTree first(a), second(b);
    const Manifold manifold = contacts(workspace, TreePair(first, second), {}, {});
    ASSERT_EQ(manifold.answer, Answer::yes);
    for (std::uint32_t i = 0; i < manifold.count; ++i) {
      EXPECT_LT(off(a, {}, manifold.points[i].place), 1e-11) << width;
      EXPECT_LT(off(b, {}, manifold.points[i].place), 1e-11) << width;
    }
  }
}

// A needle, and a corner right above a point of it: judged by the height that it was put at, in long double.
TEST(Slivers, AreNoNearerThanTheirBoundsSay) {
  Workspace workspace;
  Draw draw(3 + orchard::test::first_seed());
  for (const double width : {1e-3, 1e-5, 1e-6, 1e-7}) {
    for (std::uint64_t i = 0; i < 500 * orchard::test::more(); ++i) {
      const Pose turned = draw.pose(0);
      const PackedSphereTree needle =
          tree_of({transform(turned, {-1, 0, 0}), transform(turned, {1, 0, 0}), transform(turned, {0.9, width, 0})});
      const auto corner = [&](std::size_t k) {  // as it is stored
        const auto& vertex = needle.vertices[needle.triangles[0][k]];
        Point result{};
        for (std::size_t d = 0; d < 3; ++d) result[d] = double{vertex[d]} + needle.origin[d];
        return result;
      };
      const Point p = corner(0), q = corner(1), r = corner(2);
      using Long = std::array<long double, 3>;
      const auto minus = [](const Point& x, const Point& y) -> Long {
        return {static_cast<long double>(x[0]) - y[0], static_cast<long double>(x[1]) - y[1],
                static_cast<long double>(x[2]) - y[2]};
      };
      const Long u = minus(q, p), v = minus(r, p);
      Long n = {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
      const long double size = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
      if (!(size > 1e-9L)) continue;
      const double s = draw.uniform(0.1, 0.4), t = draw.uniform(0.1, 0.4);
      Point above{};
      for (std::size_t k = 0; k < 3; ++k) above[k] = static_cast<double>(p[k] + s * u[k] + t * v[k] + n[k] / size);
      const Long d = minus(above, p);  // off by the rounding of `above`
      const long double height = std::fabs(d[0] * n[0] + d[1] * n[1] + d[2] * n[2]) / size;
      const SurfacePoint near = nearest_point(needle, {}, above);
      EXPECT_GE(near.distance, static_cast<double>(height) - 1e-14) << width;
      EXPECT_LE(near.distance, static_cast<double>(height) + 1e-12) << width;
    }
  }
}

TEST(Slivers, LieOnFacesAsSheetsAlongTheFacesNormal) {
  Workspace workspace;
  Draw draw(4 + orchard::test::first_seed());
  const PackedSphereTree box = box_tree({1, 1, 0.5});
  const PreparedTree below(box);
  int touching = 0;
  for (std::uint64_t i = 0; i < 300 * orchard::test::more(); ++i) {
    const PackedSphereTree sheet = tree_of({{{-0.2, -0.1, 0.5}, {0.3, -0.15, 0.5}, {0.05, 0.25, 0.5}}});
    const PreparedTree above(sheet);
    const Pose pose = draw.pose(2);
    const Manifold manifold = contacts(workspace, TreePair(below, above), pose, pose);
    if (manifold.answer != Answer::yes) continue;
    ++touching;
    const Point up = rotate(pose, {0, 0, 1});
    EXPECT_GT(std::fabs(dot(Vec3(up), Vec3(manifold.normal))), 0.99) << i;
    EXPECT_LT(manifold.depth, 1e-9) << i;
  }
  EXPECT_GT(touching, 100);
}

TEST(Slivers, AreBelowPlanesWhoseNormalsAreOfAnyLength) {
  const PackedSphereTree box = box_tree({1, 1, 1});
  for (const double size : {1e-200, 3e-162, 1e-161, 1e-150, 1.0, 1e155, 1e200}) {
    const SurfacePoint deepest = deepest_point(box, {}, {0, 0, size}, 2 * size);
    EXPECT_NEAR(deepest.distance, -3, 1e-12) << size;
  }
}

}  // namespace
}  // namespace orchard::runtime
