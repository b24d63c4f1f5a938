#include <gtest/gtest.h>

#include <cmath>

#include "detector/simple_pair.h"
#include "orchard/runtime/detector.h"
#include "support.h"
#include "support/effort.h"
#include "support/query_of_trees.h"

// Boxes, spheres and capsules whose lengths are no floats, closer to each other than floats tell.
namespace orchard::runtime {
namespace {

using Long = std::array<long double, 3>;

// Of a point from a solid box.
long double distance_to_box(const Vec3& half, const Pose& pose, const Long& point) {
  long double square = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    long double at = 0;
    for (std::size_t j = 0; j < 3; ++j) at += pose.rotation[3 * j + i] * (point[j] - pose.translation[j]);
    const long double beyond = std::max(0.0L, std::fabs(at) - static_cast<long double>(pose.scale) * half[i]);
    square += beyond * beyond;
  }
  return std::sqrt(square);
}

// The distance along a segment is convex: thirds of it, again and again.
long double distance_to_box(const Vec3& half, const Pose& pose, const Long& p, const Long& q) {
  const auto at = [&](long double t) {
    return distance_to_box(half, pose, {p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2])});
  };
  long double low = 0, high = 1;
  for (int i = 0; i < 150; ++i) {
    const long double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (at(a) <= at(b) ? high : low) = at(a) <= at(b) ? b : a;
  }
  return std::min({at(0), at(1), at(low)});
}

double tiny_gap(test::Draw& draw) {
  const double size = std::pow(10, draw.uniform(-12, -6));
  return draw.uniform(0, 1) < 0.5 ? size : -size;
}

Vec3 lengths(test::Draw& draw) { return {draw.uniform(0.1, 3), draw.uniform(0.1, 3), draw.uniform(0.1, 3)}; }

// A round shape whose nearest point to the box is on a face, an edge or a corner, and about `gap` from there.
struct Beside {
  Vec3 half, p, q;
  double radius;
  Pose box_pose;

  explicit Beside(test::Draw& draw, double gap) : half(lengths(draw)), radius(draw.uniform(0.1, 2)) {
    Vec3 normal{}, from{};
    const std::uint64_t corner = draw.bits() % 8, axes = 1 + draw.bits() % 7;
    for (unsigned i = 0; i < 3; ++i) {
      const double side = corner >> i & 1 ? 1 : -1;
      const bool beyond = (axes >> i & 1) != 0;
      normal[i] = beyond ? side * draw.uniform(0.2, 1) : 0;
      from[i] = beyond ? side * half[i] : draw.uniform(-half[i], half[i]);
    }
    normal = (1 / std::sqrt(dot(normal, normal))) * normal;
    p = q = from + (radius + gap) * normal;
    if (draw.uniform(0, 1) < 0.6) q = p + draw.uniform(0.1, 3) * normal;
    box_pose = draw.pose(draw.uniform(0, 5));
    p = transform(box_pose, p), q = transform(box_pose, q);
  }
  long double gap() const {
    return distance_to_box(half, box_pose, {p[0], p[1], p[2]}, {q[0], q[1], q[2]}) - static_cast<long double>(radius);
  }
};

TEST(SimpleShapes, AreToldApartToTheLastDigitsOfDoubles) {
  int apart = 0, touching = 0;
  for (std::uint64_t i = 0; i < 2000 * orchard::test::more(); ++i) {
    test::Draw draw(orchard::test::first_seed() + i);
    const Beside beside(draw, tiny_gap(draw));
    const long double gap = beside.gap();
    if (std::fabs(gap) < 2e-13L) continue;
    Detector world;
    const ShapeId box = world.add_box(beside.half), round = world.add_capsule(beside.p, beside.q, beside.radius);
    world.add_static({{box}}, beside.box_pose);
    world.add_body(round, BodyState{});
    const bool found = !world.step(0).events.empty();
    ASSERT_EQ(found, gap < 0) << "seed " << i << ", gap " << static_cast<double>(gap);
    (found ? touching : apart) += 1;

    detail::ShapeTable shapes;
    const ShapeId a = shapes.add_box(beside.half), b = shapes.add_round(beside.p, beside.q, beside.radius);
    const Verdict verdict = detail::test_simple(shapes[a], beside.box_pose, shapes[b], {});
    ASSERT_LE(static_cast<long double>(verdict.lower_bound), std::max(0.0L, gap)) << "seed " << i;
    ASSERT_GE(verdict.lower_bound, static_cast<double>(gap) - 3e-13) << "seed " << i;
  }
  EXPECT_GT(apart, 500);
  EXPECT_GT(touching, 500);
}

// A box of doubles over a surface of floats: what touches is never told apart, and bounds are never too large.
TEST(SimpleShapes, OfABoxNothingThatTouchesIsMissed) {
  const PackedSphereTree ground = test::build_tree(test::box({-8, -8, -2}, {8, 8, 0.3125}));
  detail::ShapeTable shapes;
  int touching = 0, apart = 0;
  for (std::uint64_t i = 0; i < 1000 * orchard::test::more(); ++i) {
    test::Draw draw(orchard::test::first_seed() + i);
    const Vec3 half = lengths(draw);
    Pose pose;
    pose.translation = {draw.uniform(-4, 4), draw.uniform(-4, 4), 0.3125 + half[2] + tiny_gap(draw)};
    const long double gap = static_cast<long double>(pose.translation[2]) - half[2] - 0.3125L;
    test::OwnNarrowPhase narrow(ground, shapes[shapes.add_box(half)].tree);
    narrow.start({}, pose);
    while (!narrow.finished()) narrow.refine_exactly();
    if (gap <= 0) {
      ASSERT_EQ(narrow.answer(), Answer::yes) << i;
      ++touching;
    } else if (narrow.answer() == Answer::no) {
      ASSERT_LE(static_cast<long double>(narrow.lower_bound()), gap) << i;
      ++apart;
    } else {
      ASSERT_LT(gap, 1e-6L) << i;  // outward by the last place of a float
      ASSERT_GE(static_cast<long double>(narrow.separation_bound()), gap) << i;
    }
  }
  EXPECT_GT(touching, 300);
  EXPECT_GT(apart, 50);
}

// A long capsule that passes over a small post between two steps, and grazes it by less than its ends differ from
// floats: the sweep may not say no.
TEST(SimpleShapes, NoGrazeOfACapsuleIsSweptOver) {
  const PackedSphereTree post = test::build_tree(test::box({-0.01, -0.01, -0.04}, {0.01, 0.01, 0}));
  int hits = 0;
  for (std::uint64_t i = 0; i < 300 * orchard::test::more(); ++i) {
    test::Draw draw(orchard::test::first_seed() + i);
    const double length = draw.uniform(200, 900), radius = draw.uniform(0.005, 0.02);
    const double gap = tiny_gap(draw), height = radius + gap;
    std::vector<BodyState> states(2);
    Detector world(states_of(states), {.time_step = 0.01});
    const ShapeId capsule = world.add_capsule({0, 0, 0}, {0, 0, length}, radius);
    const BodyId body = world.add_body({{capsule}}, {.continuous_speed = 210});
    world.add_static({{world.add_shape(post)}}, {});
    const double y = draw.uniform(-0.008, 0.008);
    states[body.index].pose.translation = {-1, y, height};
    bool found = !world.step(0).events.empty();
    ASSERT_FALSE(found);
    states[body.index].pose.translation = {1, y, height};
    for (const PairEvent& event : world.step(0.01).events) found = found || event.change != PairChange::end;
    const long double true_gap = static_cast<long double>(height) - radius;
    if (true_gap <= -1e-12L) {
      ASSERT_TRUE(found) << i;
      ++hits;
    }
  }
  EXPECT_GT(hits, 100);
}

}  // namespace
}  // namespace orchard::runtime
