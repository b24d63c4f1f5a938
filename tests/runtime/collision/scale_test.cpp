// Whether bodies touch, at every size that a tree may have: as the integers say.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "lattice_scene.h"
#include "orchard/runtime/narrow_phase.h"
#include "support/query_of_trees.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

Answer answer_of(NarrowPhase& query, const Pose& a, const Pose& b, bool by_levels) {
  query.start(a, b);
  while (!query.finished()) by_levels ? query.refine() : query.refine_exactly();
  return query.answer();
}

TEST(Scale, TouchingIsDecidedExactlyAtEveryPowerOfTwoOfTheRange) {
  int touching = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Scene s = scene(seed);
    touching += s.touch;
    for (int power = kMinPower; power <= kMaxPower; ++power) {
      const PackedSphereTree a = tree_of(s.a, power), b = tree_of(s.b, power);
      ASSERT_EQ(structure_fault(a), nullptr) << seed << " 2^" << power;
      test::OwnNarrowPhase query(a, b, 64);
      for (const bool by_levels : {false, true}) {
        ASSERT_EQ(answer_of(query, {}, pose_of(s.pose, power), by_levels), s.touch ? Answer::yes : Answer::no)
            << seed << " 2^" << power;
      }
    }
    EXPECT_NE(structure_fault(tree_of(s.a, kBeyond)), nullptr) << seed;
  }
  EXPECT_GT(touching, 4);
}

// Any rotation: doubles scale exactly by powers of two, so no answer may change.
TEST(Scale, AnswersAtAnyPoseAreTheSameAtEveryPowerOfTwoOfTheRange) {
  int touching = 0;
  for (std::uint64_t seed = 100; seed < 104; ++seed) {
    const Scene s = scene(seed);
    const PackedSphereTree a = tree_of(s.a, 0), b = tree_of(s.b, 0);
    test::OwnNarrowPhase query(a, b, 64);
    std::vector<Pose> poses;
    std::vector<Answer> answers;
    Draw draw(seed);
    for (int i = 0; i < 10; ++i) {
      poses.push_back(draw.pose(draw.uniform(0, 6)));
      answers.push_back(answer_of(query, {}, poses.back(), false));
      ASSERT_EQ(answers.back() == Answer::yes,
                surfaces_intersect(placed_triangles(a, {}), placed_triangles(b, poses.back())))
          << seed;
      touching += answers.back() == Answer::yes;
    }
    for (int power = kMinPower; power <= kMaxPower; ++power) {
      const PackedSphereTree large_a = tree_of(s.a, power), large_b = tree_of(s.b, power);
      test::OwnNarrowPhase large(large_a, large_b, 64);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        Pose pose = poses[i];
        for (double& x : pose.translation) x = std::ldexp(x, power);
        ASSERT_EQ(answer_of(large, {}, pose, false), answers[i]) << seed << " 2^" << power;
      }
    }
  }
  EXPECT_GT(touching, 10);
}

// The pose's scale instead of the tree's.
TEST(Scale, OfBothPosesChangesNoAnswer) {
  for (std::uint64_t seed = 200; seed < 208; ++seed) {
    const Scene s = scene(seed);
    const PackedSphereTree a = tree_of(s.a, 0), b = tree_of(s.b, 0);
    test::OwnNarrowPhase query(a, b, 64);
    for (int power = -332; power <= 332; ++power) {
      Pose pose_a, pose_b = pose_of(s.pose, power);
      pose_a.scale = pose_b.scale = std::ldexp(1, power);
      ASSERT_EQ(answer_of(query, pose_a, pose_b, power % 2 == 0), s.touch ? Answer::yes : Answer::no)
          << seed << " 2^" << power;
    }
  }
}

// One body is 2^power times as large as the other, which touches a corner of it or stays a little off.
TEST(Scale, OfOneBodyOnlyNeverMakesATouchANo) {
  for (int power = -140; power <= 140; ++power) {
    const PackedSphereTree cube = tree_of(lattice_box({1, 1, 1}), 0);
    test::OwnNarrowPhase query(cube, cube, 64);
    for (const double step : {0.0, 0.5, 1.0, 1.5}) {
      Pose large;
      large.scale = std::ldexp(1, power);
      large.translation = {-large.scale, -large.scale, step - large.scale};  // its last corner at (0, 0, step)
      if (large.translation[2] + large.scale != step) continue;              // not to be said in doubles
      const Answer answer = answer_of(query, {}, large, false);
      const bool touch = step - large.scale <= 1;
      ASSERT_NE(answer, touch ? Answer::no : Answer::yes) << power << " " << step;
      if (std::abs(power) <= 40) {
        ASSERT_EQ(answer, touch ? Answer::yes : Answer::no) << power << " " << step;
      }
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
