#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "orchard/runtime/detector.h"
#include "support.h"
#include "support/effort.h"

// What a response needs of contacts with half-spaces: a stack that stands, and the points where a body rests.
namespace orchard::runtime {
namespace {

using test::Draw;

constexpr double kStackStep = 1.0 / 120;

Vec3 cross_of(const Vec3& p, const Vec3& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

// Cubes of edge 1 and mass 1 on top of each other, with sequential impulses.
class Stack {
 public:
  Stack(std::size_t count, bool on_half_space) : states_(count + 2), velocity_(count + 2), spin_(count + 2) {
    for (BodyState& state : states_) state.expiry = 0;
    world_ = std::make_unique<Detector>(states_of(states_), DetectorOptions{.time_step = kStackStep});
    const ShapeId cube = world_->add_box({0.5, 0.5, 0.5});
    for (std::size_t i = 0; i < count; ++i) {
      const BodyId id = world_->add_body({{cube, {}}});
      states_[id.index].pose.translation = {0.01 * static_cast<double>(i % 2), 0, 0.5 + 0.999 * static_cast<double>(i)};
      cubes_.push_back(id.index);
    }
    if (on_half_space) {
      world_->add_half_space({0, 0, 1}, 0);
    } else {
      world_->add_static({{world_->add_box({10, 10, 1}), {}}}, Pose{.translation = {0, 0, -1}});
    }
  }

  // The fastest cube's speed, as it moves: contacts give each a velocity that the fall of the next step takes away.
  double step() {
    double fastest = 0;
    for (const BodyIndex cube : cubes_) {
      velocity_[cube][2] -= 9.81 * kStackStep;
      move(cube);
      fastest = std::max(fastest, length(velocity_[cube]));
    }
    now_ += kStackStep;
    contacts_.clear();
    for (const PairEvent& event : world_->step(now_).events) add_contact(event);
    constexpr int kPasses = 60;
    for (int pass = 0; pass < kPasses; ++pass) {
      for (Contact& contact : contacts_) push(contact);
    }
    return fastest;
  }

 private:
  static constexpr double kInertia = 1.0 / 6;
  struct Contact {
    BodyIndex a, b;
    bool b_moves;
    Vec3 normal, from_a, from_b;
    double bias, pushed = 0;
    Vec3 rubbed{};
  };

  void move(BodyIndex cube) {
    Pose& pose = states_[cube].pose;
    pose.translation = Vec3(pose.translation) + kStackStep * velocity_[cube];
    const double angle = length(spin_[cube]) * kStackStep;
    if (!(angle > 0)) return;
    const Vec3 axis = (std::sin(angle / 2) / length(spin_[cube])) * spin_[cube];
    const Pose turn = *pose_from_quaternion({std::cos(angle / 2), axis[0], axis[1], axis[2]}, {0, 0, 0});
    pose.rotation = made_rigid(compose(turn, Pose{.rotation = pose.rotation}))->rotation;
  }

  void add_contact(const PairEvent& event) {
    if (event.change == PairChange::end) return;
    constexpr double kSlop = 1e-3, kShare = 0.2, kFastest = 0.5;
    const Manifold manifold = world_->manifold(event);
    const bool b_moves = world_->moves(event.b);
    const double bias = std::min(kFastest, kShare / kStackStep * std::max(0.0, manifold.depth - kSlop));
    for (std::uint32_t i = 0; i < manifold.count; ++i) {
      const Vec3 place = manifold.points[i].place;
      contacts_.push_back({event.a.index, event.b.index, b_moves, manifold.normal,
                           place - Vec3(states_[event.a.index].pose.translation),
                           b_moves ? place - Vec3(states_[event.b.index].pose.translation) : Vec3{}, bias});
    }
  }

  void push(Contact& c) {
    constexpr double kFriction = 0.5;
    const double before = c.pushed;
    c.pushed = std::max(0.0, before + (c.bias - dot(slip(c), c.normal)) / ease(c, c.normal));
    apply(c, (c.pushed - before) * c.normal);
    const Vec3 way = slip(c) - dot(slip(c), c.normal) * c.normal;
    if (!(length(way) > 0)) return;
    const Vec3 rubbed = c.rubbed;
    c.rubbed = rubbed - (1 / ease(c, (1 / length(way)) * way)) * way;
    const double most = kFriction * c.pushed;
    if (length(c.rubbed) > most) c.rubbed = (most / length(c.rubbed)) * c.rubbed;
    apply(c, c.rubbed - rubbed);
  }

  Vec3 slip(const Contact& c) const {
    const Vec3 at_a = velocity_[c.a] + cross_of(spin_[c.a], c.from_a);
    return (c.b_moves ? velocity_[c.b] + cross_of(spin_[c.b], c.from_b) : Vec3{}) - at_a;
  }
  static double ease(const Contact& c, const Vec3& way) {
    const Vec3 arm_a = cross_of(c.from_a, way), arm_b = cross_of(c.from_b, way);
    return 1 + dot(arm_a, arm_a) / kInertia + (c.b_moves ? 1 + dot(arm_b, arm_b) / kInertia : 0);
  }
  void apply(const Contact& c, const Vec3& impulse) {
    velocity_[c.a] = velocity_[c.a] - impulse;
    spin_[c.a] = spin_[c.a] - (1 / kInertia) * cross_of(c.from_a, impulse);
    if (!c.b_moves) return;
    velocity_[c.b] = velocity_[c.b] + impulse;
    spin_[c.b] = spin_[c.b] + (1 / kInertia) * cross_of(c.from_b, impulse);
  }

  std::vector<BodyState> states_;
  std::vector<Vec3> velocity_, spin_;
  std::unique_ptr<Detector> world_;
  std::vector<BodyIndex> cubes_;
  std::vector<Contact> contacts_;
  double now_ = 0;
};

double speed_at_rest(bool on_half_space) {
  constexpr int kSettling = 360, kWatched = 120;
  Stack stack(5, on_half_space);
  for (int i = 0; i < kSettling; ++i) stack.step();
  double fastest = 0;
  for (int i = 0; i < kWatched; ++i) fastest = std::max(fastest, stack.step());
  return fastest;
}

TEST(Stacks, StandOnAHalfSpaceAsOnABox) {
  constexpr double kAtRest = 0.01;  // metres per second
  EXPECT_LT(speed_at_rest(true), kAtRest);
  EXPECT_LT(speed_at_rest(false), 2 * kAtRest);
}

// The four lowest corners, by a loop over all eight in long double.
TEST(HalfSpaceContacts, OfABoxThatRestsAreItsLowestCorners) {
  for (std::uint64_t seed = 0; seed < 1000 * orchard::test::more(); ++seed) {
    Draw draw(orchard::test::first_seed() + seed);
    Detector world;
    const Vec3 half = {draw.uniform(0.2, 1), draw.uniform(0.2, 1), draw.uniform(0.2, 1)};
    const Pose scene = draw.pose(draw.uniform(0, 20));
    const Vec3 up = rotate(scene, {0, 0, 1});
    const double depth = draw.uniform(0, 0.05);
    BodyState state;
    state.pose = compose(scene, Pose{.translation = {draw.uniform(-5, 5), draw.uniform(-5, 5), half[2] - depth}});
    const BodyId box = world.add_body(world.add_box(half), state);
    world.add_half_space(up, dot(up, Vec3(scene.translation)));
    const Frame frame = world.step(0);
    ASSERT_EQ(frame.events.size(), 1u) << seed;
    ASSERT_EQ(frame.events[0].a, box);
    const Manifold m = world.manifold(frame.events[0]);
    ASSERT_EQ(m.count, 4u) << seed;
    EXPECT_NEAR(m.depth, depth, 1e-6) << seed;
    EXPECT_LT(dot(Vec3(m.normal), up), -1 + 1e-12) << seed;
    for (std::uint32_t i = 0; i < 4; ++i) {
      const Vec3 at = transform(inverse(state.pose), m.points[i].place);
      EXPECT_NEAR(std::fabs(at[0]), half[0], 1e-6) << seed;
      EXPECT_NEAR(std::fabs(at[1]), half[1], 1e-6) << seed;
      EXPECT_NEAR(dot(up, Vec3(m.points[i].place)), dot(up, Vec3(scene.translation)), 1e-9) << seed;
      EXPECT_NE(m.points[i].triangle_a, kNoTriangle);
    }
  }
}

// Far from the origin rounding decides whether a body that just touches cuts the plane: its points are at the plane all
// the same, and not in the body's middle.
TEST(HalfSpaceContacts, OfABoxThatJustTouchesFarAwayAreAtThePlane) {
  int touching = 0;
  for (std::uint64_t seed = 0; seed < 1000 * orchard::test::more(); ++seed) {
    Draw draw(orchard::test::first_seed() + seed);
    Detector world;
    BodyState state;
    state.pose = draw.pose(1e6);
    const Vec3 up = rotate(draw.pose(0), {0, 0, 1});
    const BodyId box = world.add_body(world.add_box({1, 0.5, 0.25}), state);
    double lowest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner = {i % 2 == 0 ? 1.0 : -1.0, i / 2 % 2 == 0 ? 0.5 : -0.5, i / 4 == 0 ? 0.25 : -0.25};
      lowest = std::min(lowest, dot(up, Vec3(transform(state.pose, corner))));
    }
    world.add_half_space(up, lowest);
    const Frame frame = world.step(0);
    if (frame.events.empty()) continue;
    ++touching;
    ASSERT_EQ(frame.events[0].a, box);
    const Manifold m = world.manifold(frame.events[0]);
    ASSERT_GE(m.count, 1u) << seed;
    EXPECT_LT(m.depth, 1e-8) << seed;
    for (std::uint32_t i = 0; i < m.count; ++i) {
      EXPECT_NEAR(dot(up, Vec3(m.points[i].place)), lowest, 1e-8) << seed;
      EXPECT_NE(m.points[i].triangle_a, kNoTriangle) << seed;
    }
  }
  EXPECT_GT(touching, 100);
}

TEST(HalfSpaceContacts, OfACapsuleThatLiesAreBelowBothEnds) {
  Detector world;
  BodyState state;
  state.pose.translation = {3, 4, 0.45};
  world.add_body(world.add_capsule({-1, 0, 0}, {1, 0, 0}, 0.5), state);
  world.add_half_space({0, 0, 1}, 0);
  const Frame frame = world.step(0);
  ASSERT_EQ(frame.events.size(), 1u);
  const Manifold m = world.manifold(frame.events[0]);
  ASSERT_EQ(m.count, 2u);
  EXPECT_NEAR(std::fabs(m.points[0].place[0] - m.points[1].place[0]), 2, 1e-12);
  EXPECT_NEAR(m.depth, 0.05, 1e-12);
}

TEST(HalfSpaceContacts, NameTheHalfSpaceByItsNumber) {
  Detector world;
  const ShapeId ball = world.add_sphere(1);
  std::vector<Vec3> normals = {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}};
  for (std::size_t i = 0; i < normals.size(); ++i) {
    const BodyId half = world.add_half_space(normals[i], 0);
    ASSERT_TRUE(is_half_space(half));
    EXPECT_EQ(half_space_number(half), i);
  }
  BodyState state;
  state.pose.translation = {0.5, -0.25, 0.75};
  const BodyId body = world.add_body(ball, state);
  EXPECT_FALSE(is_half_space(body));
  EXPECT_FALSE(is_half_space(kNoBody));
  const Frame frame = world.step(0);
  ASSERT_EQ(frame.events.size(), normals.size());
  for (const PairEvent& event : frame.events) {
    const Vec3 normal = normals[half_space_number(event.b)];
    EXPECT_NEAR(world.manifold(event).depth, 1 - dot(normal, Vec3(state.pose.translation)), 1e-12);
  }
}

// Out through the nearest side, with all corners; for a body whose corners alone decide.
TEST(BoxContacts, OfABodyWhollyInsideHaveTheWayOut) {
  for (std::uint64_t seed = 0; seed < 200 * orchard::test::more(); ++seed) {
    Draw draw(orchard::test::first_seed() + seed);
    Detector world;
    BodyState outer, inner;
    outer.pose = draw.pose(draw.uniform(0, 10));
    const Vec3 half = {draw.uniform(1, 3), draw.uniform(1, 3), draw.uniform(1, 3)};
    const double size = draw.uniform(0.05, 0.2);
    Pose local = draw.pose(0);
    for (std::size_t i = 0; i < 3; ++i) local.translation[i] = draw.uniform(-1, 1) * (half[i] - 2 * size);
    inner.pose = compose(outer.pose, local);
    const BodyId a = world.add_body(world.add_box(half), outer);
    const BodyId b = world.add_body(world.add_box({size, size, size}), inner);
    Frame frame = world.step(0);
    ASSERT_EQ(frame.events.size(), 1u) << seed;
    const Manifold m = world.manifold(frame.events[0]);
    ASSERT_EQ(m.answer, Answer::yes);
    // A small cube well inside leaves through a face soonest: past its lowest corner along that face's normal.
    double least = 1e300;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double reach = 0;
      for (std::size_t i = 0; i < 3; ++i) reach += size * std::fabs(local.rotation[3 * axis + i]);
      least = std::min(least, half[axis] - std::fabs(local.translation[axis]) + reach);
    }
    EXPECT_GT(m.depth, 0) << seed;
    const double rounding = 4 * 0x1p-24 * length(half);  // sides are rounded up to floats, as much as they are large
    EXPECT_LE(m.depth, least * (1 + 1e-6) + rounding) << seed;
    for (const double factor : {0.97, 1 + 1e-6}) {  // moved by the depth it is free, by less it is not
      inner.pose.translation = Vec3(compose(outer.pose, local).translation) + factor * m.depth * Vec3(m.normal);
      world.set_state(b, inner);
      frame = world.step(factor < 1 ? 0.01 : 0.02);
      ASSERT_EQ(frame.events.size(), 1u) << seed;
      EXPECT_EQ(frame.events[0].change, factor < 1 ? PairChange::stay : PairChange::end) << seed << " " << factor;
    }
    EXPECT_EQ(frame.events[0].a, a);
  }
}

}  // namespace
}  // namespace orchard::runtime
