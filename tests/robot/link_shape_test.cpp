#include "robot/link_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "apps/program.h"
#include "orchard/geometry/mesh_io.h"
#include "orchard/geometry/random.h"
#include "orchard/spheretree/sphere_audit.h"
#include "robot/primitive_mesh.h"
#include "support/shapes.h"

namespace orchard::robot {
namespace {

using std::numbers::pi;
using test::Workplace;

// Rz Ry Rx diag(scale) x + xyz, term by term.
Point moved(const Point& x, const Vector& scale, const Vector& rpy, const Vector& xyz) {
  const Point s(scale.x() * x.x(), scale.y() * x.y(), scale.z() * x.z());
  const Point a(s.x(), std::cos(rpy.x()) * s.y() - std::sin(rpy.x()) * s.z(),
                std::sin(rpy.x()) * s.y() + std::cos(rpy.x()) * s.z());
  const Point b(std::cos(rpy.y()) * a.x() + std::sin(rpy.y()) * a.z(), a.y(),
                -std::sin(rpy.y()) * a.x() + std::cos(rpy.y()) * a.z());
  return {std::cos(rpy.z()) * b.x() - std::sin(rpy.z()) * b.y() + xyz.x(),
          std::sin(rpy.z()) * b.x() + std::cos(rpy.z()) * b.y() + xyz.y(), b.z() + xyz.z()};
}

std::string collision(const std::string& mesh, const std::string& scale, const std::string& rpy,
                      const std::string& xyz) {
  return "<collision><origin rpy='" + rpy + "' xyz='" + xyz + "'/><geometry><mesh filename='" + mesh + "' scale='" +
         scale + "'/></geometry></collision>\n";
}

TEST(LinkShape, OfTwoRotatedAndScaledMeshesIsThatOfBruteForce) {
  const Workplace here;
  const TriangleMesh one = test::l_shape(), other = test::icosphere(2, 0.7);
  here.add("one.obj", one);
  here.add("other.obj", other);
  const Robot robot = read_urdf(here.add(
      "r.urdf", "<robot name='r'><link name='a'>" + collision("one.obj", "0.5 2 -1.5", "0.3 -0.2 1.1", "1 2 3") +
                    collision("other.obj", "1 1.5 1", "-2 0.4 0.1", "1.2 2 3.1") + "</link></robot>"));
  const LinkShape shape = *link_shape(robot, 0);
  std::vector<Point> expected;
  for (const Point& x : one.vertices)
    expected.push_back(moved(x, Vector(0.5, 2, -1.5), Vector(0.3, -0.2, 1.1), Vector(1, 2, 3)));
  for (const Point& x : other.vertices)
    expected.push_back(moved(x, Vector(1, 1.5, 1), Vector(-2, 0.4, 0.1), Vector(1.2, 2, 3.1)));
  ASSERT_EQ(shape.surface.mesh().vertices.size(), expected.size());
  for (std::size_t v = 0; v < expected.size(); ++v) {
    EXPECT_LT((shape.original.vertices[v] - expected[v]).norm(), 1e-9);
    EXPECT_LT((shape.surface.mesh().vertices[v] - expected[v]).norm(), 1e-9);
  }
  EXPECT_TRUE(shape.surface.solid());
  // The largest gap of one ball is at a vertex: farther than any other point of the triangles.
  const Sphere ball{Point(1, 2, 3), 0.4};
  double farthest = 0;
  for (const Point& x : expected) farthest = std::max(farthest, (x - ball.center).norm() - ball.radius);
  const Bounds gap = audit_spheres(shape.surface, std::vector{ball}).largest_gap;
  EXPECT_LE(gap.lower, farthest + 1e-9);
  EXPECT_GE(gap.upper, farthest - 1e-9);
}

TEST(LinkShape, KeepsAnElementInsideAnotherSolid) {
  const Workplace here;
  const Robot robot = read_urdf(here.add(
      "r.urdf",
      "<robot><link name='a'><collision><geometry><box size='2 2 2'/></geometry></collision><collision><geometry>"
      "<sphere radius='0.5'/></geometry></collision></link></robot>"));
  const LinkShape shape = *link_shape(robot, 0);
  EXPECT_TRUE(shape.surface.solid());
  EXPECT_TRUE(shape.surface.inside(Point(0, 0, 0.1)));
}

TEST(LinkShape, WrapsWhatIsOpenAndSaysSo) {
  const Workplace here;
  here.add("open.obj", test::open_box());
  const Robot robot = read_urdf(here.add("r.urdf",
                                         "<robot><link name='a'><collision><geometry><mesh "
                                         "filename='open.obj'/></geometry></collision></link></robot>"));
  ShapeOptions options;
  const LinkShape wrapped = *link_shape(robot, 0, options);
  options.wrap = false;
  const LinkShape open = *link_shape(robot, 0, options);
  const bool repaired = open.surface.solid();
  EXPECT_TRUE(wrapped.surface.solid());
  EXPECT_EQ(wrapped.wrapped, !repaired);
  EXPECT_TRUE(wrapped.repaired || wrapped.wrapped);
  EXPECT_FALSE(wrapped.notes.empty());
  EXPECT_FALSE(open.notes.empty());
  EXPECT_EQ(wrapped.original.triangles.size(), test::open_box().triangles.size());
}

Element primitive(Shape kind, const Vector& size) {
  Element element;
  element.shape = kind;
  element.size = size;
  return element;
}

// Of the primitive itself, from outside or on it: below 0 inside.
double distance_to(const Element& element, const Point& x) {
  const double radius = element.size.x(), half = element.size.y() / 2;
  const double across = std::hypot(x.x(), x.y());
  if (element.shape == Shape::sphere) return x.norm() - radius;
  if (element.shape == Shape::capsule) return std::hypot(across, std::max(0.0, std::abs(x.z()) - half)) - radius;
  const double out = across - radius, up = std::abs(x.z()) - half;
  return out <= 0 || up <= 0 ? std::max(out, up) : std::hypot(out, up);
}

TEST(PrimitiveMesh, HoldsThePrimitiveAndDeviatesNoMoreThanItSays) {
  for (const Element& element :
       {primitive(Shape::sphere, Vector(0.15, 0, 0)), primitive(Shape::cylinder, Vector(0.1, 0.5, 0)),
        primitive(Shape::capsule, Vector(0.1, 0.3, 0)), primitive(Shape::capsule, Vector(1, 0.01, 0))}) {
    const PrimitiveMesh made = primitive_mesh(element);
    const Surface surface(made.mesh);
    EXPECT_TRUE(surface.solid());
    EXPECT_GT(made.deviation, 0);
    EXPECT_LT(made.deviation, 0.005 * element.size.x());
    for (const Point& vertex : made.mesh.vertices) EXPECT_LE(distance_to(element, vertex), made.deviation * (1 + 1e-9));
    Random random(3, 1);
    int inside = 0;
    for (int i = 0; i < 20'000; ++i) {
      const double reach = element.size.x() + element.size.y();
      const Point x(random.uniform(-reach, reach), random.uniform(-reach, reach), random.uniform(-reach, reach));
      if (distance_to(element, x) > 0) continue;
      ++inside;
      ASSERT_LE(surface.signed_distance(x), 1e-12);
    }
    EXPECT_GT(inside, 50);
  }
  const PrimitiveMesh box = primitive_mesh(primitive(Shape::box, Vector(1, 2, 3)));
  EXPECT_EQ(box.deviation, 0);
  EXPECT_DOUBLE_EQ(Surface(box.mesh).report().volume, 6);
}

}  // namespace
}  // namespace orchard::robot
