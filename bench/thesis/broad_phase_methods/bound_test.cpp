#include "space_time_bound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "linear_program.h"
#include "worlds.h"

namespace orchard::broad_phase_methods {
namespace {

namespace test = runtime::test;

Motion random_motion(test::Draw& draw, double ball, double half_spaces) {
  Motion motion;
  motion.position = draw.in_ball(ball);
  motion.velocity = draw.uniform(0, 15) * draw.direction();
  motion.radius = draw.uniform(0, 1) < 0.2 ? 0 : draw.uniform(0, 1.5);
  motion.acceleration = draw.uniform(0, 1) < 0.2 ? 0 : draw.uniform(0, 20);
  if (draw.uniform(0, 1) < 0.2) motion.drift = draw.uniform(0, 3);
  if (draw.uniform(0, 1) < half_spaces) {
    motion.half_space = draw.uniform(0.1, 4) * draw.direction();
    if (draw.uniform(0, 1) < 0.3) motion.half_space = {0, draw.uniform(0, 1) < 0.5 ? 2.0 : -2.0, 0};  // along an axis
  }
  return motion;
}

// The body's whole sphere, wherever its centre may have gone, lies in every kind of bound; also in a chopped one.
TEST(SpaceTimeBound, HoldsTheBody) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    test::Draw draw(seed);
    const test::MovingBodies bodies({.bodies = 1, .max_acceleration = 30, .half_spaces = 0.5, .extreme = true}, seed);
    const double age = seed % 2 == 0 ? 0 : draw.uniform(0, 0.5);
    const SpaceTimeBound bound = make_bound(bodies.motion(0, 0), age, 1 - age);
    for (int step = 0; 0.05 * step <= 1 - age; ++step) {
      const double t = 0.05 * step;
      const Motion now = bodies.motion(0, age + t);
      const Vec3 off = now.position - bound.center_at(t);
      EXPECT_LE(std::sqrt(dot(off, off)) + now.radius, bound.horn_radius(t));
      EXPECT_LE(bound.horn_radius(t), bound.trapezoid_half(t) * (1 + 1e-14));
      if (!bound.has_plane()) continue;
      EXPECT_LE(dot(off, bound.normal) + now.radius, bound.cut + t * bound.cut_growth);
    }
  }
}

// Each is the earliest time, by an oracle that knows nothing of faces: a linear program over all half-spaces at once.
TEST(FirstContact, OfHypertrapezoidsWithPlanesIsTheLinearProgramsLeastTime) {
  int contacts = 0, by_planes = 0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    test::Draw draw(seed);
    const SpaceTimeBound a = make_bound(random_motion(draw, 6, 0.7), 0, 1),
                         b = make_bound(random_motion(draw, 6, 0.7), 0, 1);
    const double found = first_contact(a, b, 1, BoundShape::hypertrapezoid), expected = min_time(a, b, 1);
    if (expected == kNoContact || found == kNoContact) {
      ASSERT_EQ(found, expected) << seed;
      continue;
    }
    ASSERT_NEAR(found, expected, 1e-8) << seed;
    ++contacts;
    SpaceTimeBound plain_a = a, plain_b = b;
    plain_a.normal = plain_b.normal = {};
    by_planes += found > first_contact(plain_a, plain_b, 1, BoundShape::hypertrapezoid) + 1e-6;
  }
  EXPECT_GT(contacts, 500);
  EXPECT_GT(by_planes, 50);
}

TEST(FirstContact, OfQuadraticBoundsIsWhenTheirCubesFirstMeet) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    test::Draw draw(seed);
    const SpaceTimeBound a = make_bound(random_motion(draw, 6, 0), 0, 1),
                         b = make_bound(random_motion(draw, 6, 0), 0, 1);
    const double found = first_contact(a, b, 1, BoundShape::quadratic);
    const auto gap = [&](double t) {
      double largest = -kNoContact;
      for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, std::fabs(b.center_at(t)[i] - a.center_at(t)[i]));
      return largest - a.horn_radius(t) - b.horn_radius(t);
    };
    for (double t = 0; t <= 1 && t < found; t += 0.001) ASSERT_GT(gap(t), 0) << seed << " at " << t;
    ASSERT_LE(found <= 1 ? gap(found) : 0, 1e-9) << seed;
  }
}

// Horns lie in quadratic bounds, these in hypertrapezoids: the tighter, the later.
TEST(FirstContact, IsLaterForTighterShapes) {
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    test::Draw draw(seed);
    const SpaceTimeBound a = make_bound(random_motion(draw, 8, 0.3), 0, 1),
                         b = make_bound(random_motion(draw, 8, 0.3), 0, 1);
    const double trapezoid = first_contact(a, b, 1, BoundShape::hypertrapezoid);
    const double quadratic = first_contact(a, b, 1, BoundShape::quadratic);
    const double horn = first_contact(a, b, 1, BoundShape::horn);
    EXPECT_LE(trapezoid, quadratic + 1e-9) << seed;
    EXPECT_LE(quadratic, horn + 1e-9) << seed;
  }
}

TEST(FirstContact, OfCubesSeparatedByPlanesOnlyIsNotMissed) {  // the cubes overlap from the start
  Motion a, b;
  a.radius = b.radius = 1;
  a.position = {0, 0, 0};
  b.position = {1.5, 1.5, 0};
  a.half_space = {1, 1, 0};  // the two go towards each other along the planes' normals
  b.half_space = {-1, -1, 0};
  b.velocity = {-1, -1, 0};
  const double gap = 1.5 * std::sqrt(2.0) - 2;
  EXPECT_NEAR(first_contact(make_bound(a, 0, 1), make_bound(b, 0, 1), 1, BoundShape::hypertrapezoid),
              gap / std::sqrt(2.0), 1e-9);
}

// Which methods know which shape.
struct Way {
  IntersectionMethod method;
  BoundShape shape;
};
constexpr Way kWays[] = {{IntersectionMethod::projection, BoundShape::hypertrapezoid},
                         {IntersectionMethod::projection, BoundShape::quadratic},
                         {IntersectionMethod::subdivision, BoundShape::hypertrapezoid},
                         {IntersectionMethod::hybrid, BoundShape::hypertrapezoid},
                         {IntersectionMethod::sorted, BoundShape::hypertrapezoid},
                         {IntersectionMethod::sorted, BoundShape::quadratic},
                         {IntersectionMethod::sorted, BoundShape::horn}};

void expect_all_agree(const std::vector<SpaceTimeBound>& bounds, double duration, std::uint64_t seed) {
  IntersectionFinder finder, reference;
  for (const Way& way : kWays) {
    const Intersections& expected =
        reference.find(bounds, duration, {.method = IntersectionMethod::all_pairs, .shape = way.shape});
    for (const std::uint32_t base_case : {4u, 32u}) {
      const Intersections& found =
          finder.find(bounds, duration, {.method = way.method, .shape = way.shape, .base_case = base_case});
      if (expected.earliest.time == kNoContact || found.earliest.time == kNoContact) {
        ASSERT_EQ(found.earliest.time, expected.earliest.time) << "seed " << seed << " way " << &way - kWays;
      } else {
        ASSERT_NEAR(found.earliest.time, expected.earliest.time, 1e-9 * duration)
            << "seed " << seed << " way " << &way - kWays;
      }
      ASSERT_EQ(found.initial.size(), expected.initial.size()) << seed;
      for (std::size_t i = 0; i < found.initial.size(); ++i) {
        ASSERT_EQ(found.initial[i].a, expected.initial[i].a);
        ASSERT_EQ(found.initial[i].b, expected.initial[i].b);
        ASSERT_EQ(found.initial[i].time, expected.initial[i].time);
      }
    }
  }
}

TEST(IntersectionFinder, AllMethodsAgreeOnTheEarliestTime) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    test::Draw draw(seed);
    const std::size_t n = seed % 200 == 0 ? 300 : seed % 20 == 0 ? 60 : 2 + seed % 12;
    const double ball = std::cbrt(static_cast<double>(n)) * draw.uniform(2, 20);
    std::vector<SpaceTimeBound> bounds;
    for (std::size_t i = 0; i < n; ++i) {
      bounds.push_back(
          make_bound(random_motion(draw, ball, seed % 3 == 0 ? 0 : 0.6), seed % 4 == 3 ? draw.uniform(0, 0.2) : 0, 1));
    }
    expect_all_agree(bounds, 1, seed);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(IntersectionFinder, AllMethodsAgreeOnAlignedAndDegenerateConfigurations) {  // as in 4.2.5, and worse
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    test::Draw draw(seed);
    std::vector<SpaceTimeBound> bounds;
    for (std::size_t i = 0; i < 60; ++i) {
      Motion m;
      m.position = draw.in_ball(100);
      m.velocity = draw.uniform(5, 15) * draw.direction();
      m.radius = seed % 5 == 0 ? 0 : draw.uniform(0.5, 1.5);
      m.acceleration = seed % 2 == 0 ? 0 : draw.uniform(0, 4);
      if (seed % 4 < 2) {  // aligned with the x axis
        m.position[0] = draw.uniform(-0.1, 0.1);
        m.velocity = {m.velocity[0], 0, 0};
      } else {  // with the x-y plane
        m.position = {draw.uniform(-0.1, 0.1), draw.uniform(-0.1, 0.1), draw.uniform(-400, 400)};
        m.velocity[2] = 0;
      }
      if (seed % 3 == 0) m.velocity = {1, 2, 3};  // all the same
      if (seed % 7 == 0) m.position = {std::round(m.position[0]), std::round(m.position[1]), std::round(m.position[2])};
      bounds.push_back(make_bound(m, 0, 1));
    }
    if (seed % 11 == 0) bounds[1] = bounds[0];
    expect_all_agree(bounds, 1, seed);
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(IntersectionFinder, ReportsAllPairsThatMeetAtTheStart) {
  test::Draw draw(4);
  std::vector<SpaceTimeBound> bounds;
  for (std::size_t i = 0; i < 80; ++i) bounds.push_back(make_bound(random_motion(draw, 8, 0.5), 0, 1));
  std::vector<std::pair<std::uint32_t, std::uint32_t>> expected, found;
  for (std::uint32_t i = 0; i < bounds.size(); ++i) {
    for (std::uint32_t j = i + 1; j < bounds.size(); ++j) {
      bool meet = true;
      for (std::size_t d = 0; d < 3; ++d) {
        meet = meet && std::fabs(bounds[j].center[d] - bounds[i].center[d]) <= bounds[i].size + bounds[j].size;
      }
      if (meet) expected.emplace_back(i, j);
    }
  }
  IntersectionFinder finder;
  for (const BoundContact& c : finder.find(bounds, 1, {}).initial) found.emplace_back(c.a, c.b);
  EXPECT_EQ(found, expected);
  EXPECT_GT(expected.size(), 10u);
}

}  // namespace
}  // namespace orchard::broad_phase_methods
