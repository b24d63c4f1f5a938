#include "robot/link_fit.h"

#include <gtest/gtest.h>

#include <numeric>

#include "apps/program.h"
#include "orchard/geometry/error.h"
#include "orchard/geometry/random.h"

namespace orchard::robot {
namespace {

using test::Workplace;

Sphere as_float(const Sphere& s) {
  const auto f = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  return {Point(f(s.center.x()), f(s.center.y()), f(s.center.z())), f(s.radius)};
}

bool holds(const Sphere& outer, const Sphere& inner) {
  return (outer.center - inner.center).norm() + inner.radius <= outer.radius;
}

TEST(RoundedSpheres, HoldOrLieInTheSphereHoweverReadersHoldThem) {
  Random random(5, 1);
  for (int i = 0; i < 20'000; ++i) {
    const double scale = std::pow(10.0, random.uniform(-3, 3));
    const Sphere sphere{scale * Point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)),
                        scale * random.uniform(0.001, 1)};
    const Sphere out = rounded(sphere, true), in = rounded(sphere, false);
    ASSERT_TRUE(holds(out, sphere));
    ASSERT_TRUE(holds(as_float(out), sphere));
    ASSERT_LT(out.radius, sphere.radius + 1e-6 * (1 + scale));
    if (in.radius == 0) continue;
    ASSERT_TRUE(holds(sphere, in));
    ASSERT_TRUE(holds(sphere, as_float(in))) << sphere.radius << " " << in.radius << " " << sphere.center.transpose();
  }
}

// A large box, a small one, and a wheel.
struct Cart {
  Workplace here;
  std::string file = here.add(
      "cart.urdf",
      "<robot name='cart'><link name='large'><collision><geometry><box size='2 1 0.3'/></geometry></collision></link>"
      "<link name='none'/><link name='small'><collision><origin xyz='0 0 1' rpy='0.3 0 0'/><geometry>"
      "<box size='0.2 0.1 0.1'/></geometry></collision></link><link name='wheel'><collision><geometry><cylinder "
      "radius='0.3' length='0.1'/></geometry></collision></link></robot>");
  Robot robot = read_urdf(file);
  std::vector<LinkShape> shapes = link_shapes(robot);
};

TEST(ShareSpheres, GivesTheNextOneToWhatIsLoosestAndUsesAll) {
  const Cart cart;
  const auto shared = [&](const FitOptions& options) { return share_spheres(cart.robot, cart.shapes, options); };
  const std::vector<Index> counts = shared({.spheres = 20});
  ASSERT_EQ(counts.size(), 3);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0u), 20);
  EXPECT_GT(counts[0], counts[2]);
  EXPECT_GT(counts[2], counts[1]);
  const std::vector<Index> fixed = shared({.spheres = 20, .spheres_of = {{2, 9}}});
  EXPECT_EQ(fixed[1], 9);
  EXPECT_EQ(std::accumulate(fixed.begin(), fixed.end(), 0u), 20);
  EXPECT_EQ(shared({.spheres = 3}), (std::vector<Index>{1, 1, 1}));
  EXPECT_THROW(shared({.spheres = 2}), InputError);
  EXPECT_THROW(shared({.spheres = 10, .spheres_of = {{2, 9}}}), InputError);
}

TEST(LinkFit, HoldsTheSurfaceAndThePrimitiveItself) {
  const Cart cart;
  const std::vector<LinkFit> fits = fit_links(cart.robot, cart.shapes, {.spheres = 15, .effort = Effort::low});
  for (std::size_t i = 0; i < fits.size(); ++i) {
    EXPECT_TRUE(fits[i].kept);
    EXPECT_TRUE(fits[i].audit.covered);
    for (const auto& [a, b, c] : cart.shapes[i].original.triangles) {
      Random random(9, i, a);
      const auto& v = cart.shapes[i].original.vertices;
      for (int k = 0; k < 20; ++k) {
        double s = random.uniform(), t = random.uniform();
        if (s + t > 1) s = 1 - s, t = 1 - t;
        const Point x = v[a] + s * (v[b] - v[a]) + t * (v[c] - v[a]);
        double gap = 1;
        for (const Sphere& sphere : fits[i].spheres) {
          const Sphere f = as_float(sphere);
          gap = std::min(gap, (x - f.center).norm() - f.radius);
        }
        ASSERT_LE(gap, 1e-12);
      }
    }
  }
  // The rim of the wheel proper, which lies within the polyhedron around it.
  for (int k = 0; k < 1000; ++k) {
    const Point rim(0.3 * std::cos(k * 0.00628), 0.3 * std::sin(k * 0.00628), 0.05);
    EXPECT_LE(gap_from(fits[2].spheres, rim), 0);
  }
}

TEST(LinkFit, TakesAFitOfItsOwnForALink) {
  const Cart cart;
  const std::vector<LinkFit> fits =
      fit_links(cart.robot, cart.shapes, {.spheres = 12, .fit_of = {{0, SphereFit::inside}}, .effort = Effort::low});
  EXPECT_EQ(fits[0].fit, SphereFit::inside);
  EXPECT_EQ(fits[1].fit, SphereFit::cover);
  EXPECT_TRUE(fits[0].kept);
  for (const Sphere& sphere : fits[0].spheres)
    EXPECT_LE(cart.shapes[0].surface.signed_distance(as_float(sphere).center) + as_float(sphere).radius, 1e-12);
}

}  // namespace
}  // namespace orchard::robot
