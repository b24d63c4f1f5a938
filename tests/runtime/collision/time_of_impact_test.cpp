#include "orchard/runtime/time_of_impact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "allocation.h"
#include "bodies.h"
#include "improper_poses.h"
#include "orchard/runtime/packed_tree.h"
#include "support/effort.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

Travel straight(const Pose& start, const Vec& velocity) {
  Travel travel;
  travel.start = start;
  travel.velocity = velocity;
  return travel;
}

// What a result claims, asked of whole queries at many times.
void judge(Workspace& workspace, const TreePair& pair, const Travel& a, const Travel& b, const ImpactOptions& options,
           const Impact& impact, int samples, const std::string& name) {
  ASSERT_TRUE(impact.finished) << name;
  ASSERT_FALSE(impact.refused) << name;
  ASSERT_LE(options.begin, impact.t0) << name;
  ASSERT_LE(impact.t0, options.end) << name;
  const auto touching = [&](double time) {
    return collide(workspace, pair, a.at(time), b.at(time)).answer == Answer::yes;
  };
  for (int i = 0; i <= samples; ++i) {
    const double time = options.begin + (options.end - options.begin) * i / samples;
    if (time >= impact.t0 && impact.answer != Answer::no) break;
    ASSERT_FALSE(touching(time)) << name << ": missed at " << time << ", t0 = " << impact.t0;
  }
  if (impact.answer == Answer::no) {
    ASSERT_EQ(impact.t0, options.end) << name;
    return;
  }
  if (impact.answer == Answer::yes) {
    ASSERT_LE(impact.t0, impact.t1) << name;
    ASSERT_LE(impact.t1, options.end) << name;
    ASSERT_TRUE(touching(impact.t1)) << name;
  }
  const Distance apart = distance(workspace, pair, a.at(impact.t0), b.at(impact.t0), {.relative = 1e-6});
  ASSERT_LE(apart.lower, impact.distance) << name;
  ASSERT_LE(apart.lower, 1.01 * std::max(options.tolerance, 2e-5 * (pair.a().extent + 4 * pair.b().extent))) << name;
}

TEST(TimeOfImpact, IsTheClosedFormOfFallingAndTurningBoxes) {
  const auto floor_tree = box_tree({10, 10, 0.5}), cube_tree = box_tree({0.5, 0.5, 0.5}),
             bar_tree = box_tree({2, 0.1, 0.1});
  const PreparedTree ground(floor_tree), cube(cube_tree), bar(bar_tree);
  Workspace workspace;
  const ImpactOptions fine{.tolerance = 1e-7};
  // A cube whose lower face is 1.5 above the ground, falling at 4.
  const Impact fall = time_of_impact(workspace, TreePair(ground, cube), {},
                                     straight(Pose{.translation = {0, 0, 2.5}}, {1, 0, -4}), fine);
  EXPECT_EQ(fall.answer, Answer::yes);
  EXPECT_LE(fall.t0, 1.5 / 4);
  EXPECT_NEAR(fall.t0, 1.5 / 4, 1e-6);
  EXPECT_NEAR(fall.t1, 1.5 / 4, 1e-6);
  // A level bar 1 above the ground turning about its middle: its end gets there when 2 sin x + 0.1 cos x = 1.
  Travel turning = straight(Pose{.translation = {0, 0, 1.5}}, {0, 0, 0});
  turning.spin = {0, std::numbers::pi / 2, 0};
  const Impact turn = time_of_impact(workspace, TreePair(ground, bar), {}, turning, fine);
  const double angle = std::asin(1 / std::hypot(2, 0.1)) - std::atan2(0.1, 2);
  EXPECT_EQ(turn.answer, Answer::yes);
  EXPECT_LE(turn.t0, angle / (std::numbers::pi / 2));
  EXPECT_NEAR(turn.t0, angle / (std::numbers::pi / 2), 1e-6);
  // Both at once, the whole scene falling, too: only relative motion counts.
  Travel falling_ground = straight({}, {3, -7, -5});
  Travel with_it = turning;
  with_it.velocity = {3, -7, -5};
  EXPECT_NEAR(time_of_impact(workspace, TreePair(ground, bar), falling_ground, with_it, fine).t0, turn.t0,
              fine.tolerance);
  // A helix about an axis through a point off the bar.
  Travel screw = turning;
  screw.center = {-2, 0, 0};
  const double about_end = std::asin(1 / std::hypot(4, 0.1)) - std::atan2(0.1, 4);
  EXPECT_NEAR(time_of_impact(workspace, TreePair(ground, bar), {}, screw, fine).t0, about_end / (std::numbers::pi / 2),
              1e-6);
}

TEST(TimeOfImpact, NeverTunnelsThroughThinAndFastThings) {
  Workspace workspace;
  for (const double thin : {1e-3, 1e-6, 1e-9}) {
    const auto plate_tree = box_tree({1, 1, thin});
    const PreparedTree plate(plate_tree);
    const TreePair pair(plate, plate);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Draw draw(seed);
      const double speed = draw.uniform(10, 1e6), height = draw.uniform(0.1, 0.9) * speed;
      const Impact impact =
          time_of_impact(workspace, pair, {}, straight(Pose{.translation = {0.3, 0.2, height}}, {0, 0, -speed}));
      // Thinner than what rounding leaves of a length of 1, it may be too near to be known, but never "no".
      ASSERT_TRUE(impact.answer == Answer::yes || (thin < 1e-8 && impact.answer == Answer::maybe)) << thin << seed;
      ASSERT_NEAR(impact.t0, (height - 2 * thin) / speed, 2e-4 / speed) << thin << " " << seed;
      // Edge to edge, and past each other by twice a hair.
      const Pose beside = Pose{.translation = {2 + (seed % 2 == 0 ? 1e-4 : -1e-4), 0, height}};
      const Impact edge = time_of_impact(workspace, pair, {}, straight(beside, {0, 0, -speed}), {.tolerance = 1e-6});
      ASSERT_EQ(edge.answer == Answer::no, seed % 2 == 0) << thin << " " << seed;
    }
    // A blade that turns a hundred times while it comes.
    Travel blade = straight(Pose{.translation = {0, 0, 3}}, {0, 0, -4});
    blade.spin = {200 * std::numbers::pi, 0, 0};
    const ImpactOptions options{.tolerance = 1e-3};
    judge(workspace, pair, {}, blade, options, time_of_impact(workspace, pair, {}, blade, options), 4000, "blade");
  }
}

TEST(TimeOfImpact, MissesNothingThatSamplingSees) {
  const auto all = bodies();
  std::vector<PreparedTree> trees;
  for (const Body& body : all) trees.emplace_back(body.tree);
  Workspace workspace, other;
  int yes = 0, no = 0, maybe = 0;
  const std::uint64_t first = orchard::test::first_seed(), more = orchard::test::more();
  for (std::uint64_t seed = first; seed < first + 150 * more; ++seed) {
    Draw draw(seed);
    const std::size_t i = draw.bits() % all.size(), j = draw.bits() % all.size();
    const double reach = all[i].tree.bounding_radius + all[j].tree.bounding_radius;
    const auto travel = [&](const Body& body, double far) {
      Pose pose = draw.pose(far);
      pose.scale = seed % 5 == 0 ? draw.uniform(0.5, 1.5) : 1;
      const SiblingBlock& root = body.tree.blocks[0];
      Travel t = straight(centered(body.tree, pose), draw.direction());
      const double speed = draw.uniform(0, 2) * reach, spin = seed % 3 == 0 ? 0 : draw.uniform(0, 5);
      const Vec axis = draw.direction();
      for (std::size_t k = 0; k < 3; ++k) {
        t.velocity[k] *= speed, t.spin[k] = spin * axis[k];
        t.center[k] = body.tree.origin[k] + (seed % 2 == 0 ? root.x[0] : draw.uniform(-1, 1));
      }
      return t;
    };
    const Travel a = travel(all[i], 0), b = travel(all[j], draw.uniform(0.5, 1.5) * reach);
    const TreePair pair(trees[i], trees[j]);
    const ImpactOptions options{.begin = 0, .end = 1, .tolerance = 1e-3 * reach};
    const Impact impact = time_of_impact(workspace, pair, a, b, options);
    judge(other, pair, a, b, options, impact, 300, all[i].name + ", " + all[j].name + " " + std::to_string(seed));
    (impact.answer == Answer::yes ? yes : impact.answer == Answer::no ? no : maybe) += 1;
    // The same motions, known by nothing but a function and its bounds.
    if (seed % 4 != 0) continue;
    const auto known_by_function = [](const Travel& t) {
      Travel result;
      result.start = t.start, result.center = t.center;
      result.pose_at = [](const void* context, double time) { return static_cast<const Travel*>(context)->at(time); };
      result.context = &t;
      result.speed = std::hypot(t.velocity[0], t.velocity[1], t.velocity[2]) * (1 + 1e-12);
      result.turning = std::hypot(t.spin[0], t.spin[1], t.spin[2]) * (1 + 1e-12);
      return result;
    };
    const Travel fa = known_by_function(a), fb = known_by_function(b);
    const Impact by_function = time_of_impact(workspace, pair, fa, fb, options);
    judge(other, pair, fa, fb, options, by_function, 300, "by function " + std::to_string(seed));
  }
  EXPECT_GT(yes, 40);
  EXPECT_GT(no, 20);
  EXPECT_LT(maybe, static_cast<int>(20 * more));
}

TEST(TimeOfImpact, SaysSoWhereTheyTouchAtTheStart) {
  const auto tree = box_tree({1, 1, 1});
  const PreparedTree cube(tree);
  Workspace workspace;
  const Impact impact =
      time_of_impact(workspace, TreePair(cube, cube), {}, straight(Pose{.translation = {1.5, 0, 0}}, {5, 0, 0}));
  EXPECT_EQ(impact.answer, Answer::yes);
  EXPECT_EQ(impact.t0, 0);
  EXPECT_EQ(impact.t1, 0);
  EXPECT_TRUE(impact.finished);
}

TEST(TimeOfImpact, ComesNearerWithEveryBudgetAndNeverTooFar) {
  const auto all = bodies();
  const PreparedTree a(all[2].tree), b(all[5].tree);
  Workspace workspace;
  int interrupted = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Draw draw(seed);
    Travel b_moves = straight(draw.pose(3), {});
    for (std::size_t k = 0; k < 3; ++k) b_moves.velocity[k] = -1.5 * b_moves.start.translation[k];
    b_moves.spin = {1, 2, 0.5};
    const TreePair pair(a, b);
    const Impact whole = time_of_impact(workspace, pair, {}, b_moves);
    ImpactOptions options{.budget = {.work = 60}};
    Impact part = time_of_impact(workspace, pair, {}, b_moves, options);
    for (int i = 0; i < 2000 && !part.finished; ++i) {
      ASSERT_LT(part.work, options.budget.work + kLeafPairTests * kTriangleTestCost) << seed;
      ASSERT_GE(part.t0, options.begin) << seed;
      if (whole.answer == Answer::yes) {
        ASSERT_LE(part.t0, whole.t1) << seed;
      }
      ++interrupted;
      if (part.t0 == options.begin) options.budget.work *= 2;  // too little for one step here
      options.begin = part.t0;
      part = time_of_impact(workspace, pair, {}, b_moves, options);
    }
    ASSERT_TRUE(part.finished) << seed;
    ASSERT_EQ(part.answer, whole.answer) << seed;
    ASSERT_NEAR(part.t0, whole.t0, 1e-3) << seed;
  }
  EXPECT_GT(interrupted, 50);
}

TEST(TimeOfImpact, CastsSpheresAndCapsulesAsPointsAndSegmentsWithAMargin) {
  const auto wall_tree = box_tree({0.5, 5, 5}), point = point_tree({0, 0, 0}),
             segment = segment_tree({0, -1, 0}, {0, 1, 0});
  const PreparedTree wall(wall_tree), ball(point), capsule(segment);
  Workspace workspace;
  for (const double radius : {0.01, 0.3, 1.0}) {
    const ImpactOptions options{.tolerance = 1e-7, .margin = radius};
    for (const PreparedTree* shape : {&ball, &capsule}) {
      const Impact impact = time_of_impact(workspace, TreePair(wall, *shape), {},
                                           straight(Pose{.translation = {4, 0.3, 0.2}}, {-7, 1, 0}), options);
      EXPECT_NE(impact.answer, Answer::no);
      EXPECT_NEAR(impact.t0, (3.5 - radius) / 7, 1e-6) << radius;
      EXPECT_LE(impact.t0, (3.5 - radius) / 7);
    }
    // Past the wall's edge: the nearest way is 2 to the side.
    const Impact past = time_of_impact(workspace, TreePair(wall, ball), {},
                                       straight(Pose{.translation = {4, 7, 0}}, {-8, 0, 0}), options);
    EXPECT_EQ(past.answer, Answer::no);
  }
}

TEST(TimeOfImpact, RefusesWhatIsNoMotion) {
  const auto tree = box_tree({1, 1, 1});
  const PreparedTree cube(tree);
  Workspace workspace;
  const TreePair pair(cube, cube);
  const auto refused = [&](const Travel& travel, const ImpactOptions& options = {}) {
    const Impact impact = time_of_impact(workspace, pair, {}, travel, options);
    return impact.refused && impact.answer == Answer::maybe && impact.t0 == options.begin;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Pose away{.translation = {5, 0, 0}};
  for (const auto& [name, pose] : improper_poses(Draw(1).pose(5)))
    EXPECT_TRUE(refused(straight(pose, {-1, 0, 0}))) << name;
  EXPECT_TRUE(refused(straight(away, {nan, 0, 0})));
  EXPECT_TRUE(refused(straight(away, {1e300, 0, 0})));
  Travel spinning = straight(away, {0, 0, 0});
  spinning.spin = {nan, 0, 0};
  EXPECT_TRUE(refused(spinning));
  EXPECT_TRUE(refused(straight(away, {}), {.margin = nan}));
  EXPECT_TRUE(refused(straight(away, {}), {.begin = 1, .end = 0}));
}

TEST(TimeOfImpact, TravelsFromPoseToPose) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    const Pose from = draw.pose(3);
    Pose to = draw.pose(3);
    if (seed % 4 == 0) {  // half a turn about some axis, exactly or nearly
      const Vec axis = draw.direction();
      const double half = std::numbers::pi / 2 - (seed % 8 == 0 ? 0 : 1e-9);
      to = compose(*pose_from_quaternion(
                       {std::cos(half), std::sin(half) * axis[0], std::sin(half) * axis[1], std::sin(half) * axis[2]},
                       {0, 0, 0}),
                   from);
      if (const auto rigid = made_rigid(to)) to = *rigid;
    }
    if (seed % 4 == 1) to.rotation = from.rotation;
    const Vec center = {draw.uniform(-1, 1), 0.3, -0.2};
    const Travel travel = travel_between(from, to, center);
    const Pose begin = travel.at(0), end = travel.at(1);
    for (std::size_t i = 0; i < 9; ++i) {
      ASSERT_NEAR(begin.rotation[i], from.rotation[i], 1e-14) << seed;
      ASSERT_NEAR(end.rotation[i], to.rotation[i], 1e-9) << seed;
    }
    const Vec p = transform(end, center), q = transform(to, center);
    for (std::size_t i = 0; i < 3; ++i) ASSERT_NEAR(p[i], q[i], 1e-12) << seed;
    ASSERT_LE(std::hypot(travel.spin[0], travel.spin[1], travel.spin[2]), std::numbers::pi + 1e-9) << seed;
    ASSERT_TRUE(is_rigid(travel.at(0.37))) << seed;
  }
}

TEST(TimeOfImpact, AllocatesNothingOnceWarm) {
  const auto all = bodies();
  const PreparedTree a(all[2].tree), b(all[5].tree);
  Workspace workspace;
  const auto ask = [&] {
    time_of_impact(workspace, TreePair(a, b), {}, straight(Pose{.translation = {4, 0, 0}}, {-3, 0, 0}));
  };
  ask();
  const std::size_t before = allocations;
  ask();
  EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace orchard::runtime
