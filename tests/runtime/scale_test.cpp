// The same questions at every size that a tree may have: the answers must be those of integers, which no size changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "lattice.h"
#include "orchard/runtime/distance.h"
#include "orchard/runtime/narrow_phase.h"
#include "orchard/runtime/shape_query.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

// 2^-149 is the least float. Coordinates and radii are below 12: at 2^56 within 1e18, and at 2^60 those of 1 are
// beyond.
constexpr int kLeastPower = -149, kMostPower = 56, kBeyond = 60;

using LatticeMesh = std::vector<LatticeTriangle>;

LatticeMesh lattice_soup(Draw& draw, std::size_t triangles, std::int64_t side) {
  LatticeMesh mesh(triangles);
  for (LatticeTriangle& t : mesh) {
    Lattice corner{};
    for (std::int64_t& x : corner) x = static_cast<std::int64_t>(draw.bits() % static_cast<std::uint64_t>(side));
    for (Lattice& p : t) {
      for (std::size_t i = 0; i < 3; ++i) p[i] = corner[i] + static_cast<std::int64_t>(draw.bits() % 6) - 3;
    }
  }
  return mesh;
}

LatticeMesh lattice_box(const Lattice& size) {
  LatticeMesh mesh;
  const Mesh unit = box({0, 0, 0}, {1, 1, 1});
  for (const auto& t : unit.triangles) {
    LatticeTriangle& triangle = mesh.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) {
        triangle[k][i] = static_cast<std::int64_t>(unit.vertices[t[k]][i]) * size[i];
      }
    }
  }
  return mesh;
}

PackedSphereTree tree_of(const LatticeMesh& lattice, int power) {
  Mesh mesh;
  mesh.closed = false;
  for (const LatticeTriangle& t : lattice) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Lattice& p : t) {
      Vec v{};
      for (std::size_t i = 0; i < 3; ++i) v[i] = std::ldexp(static_cast<double>(p[i]), power);
      mesh.vertices.push_back(v);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return build_tree(mesh, {.branching = 3, .leaf_triangles = 2, .bounds = false});
}

// One of the 24 rotations that keep the lattice, and a step.
struct LatticePose {
  std::array<std::array<std::int64_t, 3>, 3> rotation{};
  Lattice step{};
};

LatticePose lattice_pose(Draw& draw, std::int64_t reach) {
  LatticePose pose;
  const std::size_t first = draw.bits() % 3, second = (first + 1 + draw.bits() % 2) % 3, third = 3 - first - second;
  const std::int64_t s = draw.bits() % 2 == 0 ? 1 : -1, t = draw.bits() % 2 == 0 ? 1 : -1;
  const bool even = second == (first + 1) % 3;
  pose.rotation[0][first] = s, pose.rotation[1][second] = t, pose.rotation[2][third] = even ? s * t : -s * t;
  for (std::int64_t& x : pose.step) {
    x = static_cast<std::int64_t>(draw.bits() % static_cast<std::uint64_t>(2 * reach + 1)) - reach;
  }
  return pose;
}

LatticeMesh moved(LatticeMesh mesh, const LatticePose& pose) {
  for (LatticeTriangle& t : mesh) {
    for (Lattice& p : t) {
      Lattice q = pose.step;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) q[i] += pose.rotation[i][j] * p[j];
      }
      p = q;
    }
  }
  return mesh;
}

Pose pose_of(const LatticePose& from, int power) {
  Pose pose;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) pose.rotation[3 * i + j] = static_cast<double>(from.rotation[i][j]);
    pose.translation[i] = std::ldexp(static_cast<double>(from.step[i]), power);
  }
  return pose;
}

bool meet(const LatticeMesh& a, const LatticeMesh& b) {
  return std::any_of(a.begin(), a.end(), [&b](const LatticeTriangle& t) {
    return std::any_of(b.begin(), b.end(), [&t](const LatticeTriangle& u) { return lattice_triangles_meet(t, u); });
  });
}

struct Scene {
  LatticeMesh a, b;
  LatticePose pose;
  bool touch;
};

// Boxes, which touch by a face, an edge or a corner, and soups.
Scene scene(std::uint64_t seed) {
  Draw draw(seed);
  const auto side = [&draw] { return static_cast<std::int64_t>(1 + draw.bits() % 4); };
  Scene s;
  if (seed % 2 == 0) {
    s.a = lattice_box({side(), side(), side()}), s.b = lattice_box({side(), side(), side()});
    s.pose = lattice_pose(draw, 2);
  } else {
    s.a = lattice_soup(draw, 1 + draw.bits() % 20, 8), s.b = lattice_soup(draw, 1 + draw.bits() % 20, 8);
    s.pose = lattice_pose(draw, 3);
  }
  s.touch = meet(s.a, moved(s.b, s.pose));
  return s;
}

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
    for (int power = kLeastPower; power <= kMostPower; ++power) {
      const PackedSphereTree a = tree_of(s.a, power), b = tree_of(s.b, power);
      ASSERT_EQ(structure_fault(a), nullptr) << seed << " 2^" << power;
      NarrowPhase query(a, b, 64);
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
    NarrowPhase query(a, b, 64);
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
    for (int power = kLeastPower; power <= kMostPower; ++power) {
      const PackedSphereTree large_a = tree_of(s.a, power), large_b = tree_of(s.b, power);
      NarrowPhase large(large_a, large_b, 64);
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
    NarrowPhase query(a, b, 64);
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
    NarrowPhase query(cube, cube, 64);
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

TEST(Scale, DistancesHoldAtEveryPowerOfTwoOfTheRange) {
  for (std::uint64_t seed = 300; seed < 304; ++seed) {
    const Scene s = scene(seed);
    const PackedSphereTree a = tree_of(s.a, 0), b = tree_of(s.b, 0);
    Draw draw(seed);
    for (int i = 0; i < 2; ++i) {
      const Pose pose = draw.pose(draw.uniform(4, 20));
      const auto truth = static_cast<double>(surface_distance(placed_triangles(a, {}), placed_triangles(b, pose)));
      for (int power = kLeastPower; power <= kMostPower; ++power) {
        const PackedSphereTree large_a = tree_of(s.a, power), large_b = tree_of(s.b, power);
        Pose at = pose;
        for (double& x : at.translation) x = std::ldexp(x, power);
        DistanceQuery query(large_a, large_b);
        query.start({}, at);
        query.refine();
        ASSERT_TRUE(query.finished());
        const double unit = std::ldexp(1, power), near = 1e-9 * unit;
        ASSERT_LE(query.lower(), truth * unit + near) << seed << " 2^" << power;
        ASSERT_GE(query.upper(), truth * unit - near) << seed << " 2^" << power;
        ASSERT_LE(query.upper(), 1.01 * query.lower() + 1e-5 * unit) << seed << " 2^" << power;
      }
    }
  }
}

TEST(Scale, RaysCapsulesAndInsidesAreTheSameAtEveryPowerOfTwoOfTheRange) {
  int hits = 0, misses = 0;
  const LatticeMesh cube = lattice_box({4, 3, 2});
  for (int power = kLeastPower; power <= kMostPower; ++power) {
    const PackedSphereTree tree = tree_of(cube, power);
    const double unit = std::ldexp(1, power);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      Draw draw(seed);
      // From lattice points to lattice points: which of them are inside, or on the surface, is plain.
      Lattice p{}, q{};
      for (Lattice* v : {&p, &q}) {
        for (std::int64_t& x : *v) x = static_cast<std::int64_t>(draw.bits() % 8) - 2;
      }
      const LatticeTriangle segment = {p, q, q};
      const bool touch = meet({segment}, cube);
      (touch ? hits : misses) += 1;
      Vec from{}, to{}, way{};
      for (std::size_t i = 0; i < 3; ++i) {
        from[i] = static_cast<double>(p[i]) * unit, to[i] = static_cast<double>(q[i]) * unit;
        way[i] = static_cast<double>(q[i] - p[i]);
      }
      ASSERT_EQ(cast_ray(tree, {}, from, way, unit).has_value(), touch) << seed << " 2^" << power;
      const SurfacePoint near = nearest_point_to_segment(tree, {}, from, to, 0);
      ASSERT_EQ(near.triangle != kNoTriangle, touch) << seed << " 2^" << power;
      const SurfacePoint all = nearest_point_to_segment(tree, {}, from, to);
      ASSERT_EQ(all.distance == 0, touch) << seed << " 2^" << power;
      const auto strictly = [&p](std::int64_t x, std::int64_t y, std::int64_t z) {
        return p[0] > 0 && p[0] < x && p[1] > 0 && p[1] < y && p[2] > 0 && p[2] < z;
      };
      const bool outside = p[0] < 0 || p[0] > 4 || p[1] < 0 || p[1] > 3 || p[2] < 0 || p[2] > 2;
      if (strictly(4, 3, 2)) {
        ASSERT_TRUE(contains(tree, {}, from)) << seed << " 2^" << power;
      }
      if (outside) {
        ASSERT_FALSE(contains(tree, {}, from)) << seed << " 2^" << power;
      }
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
}

TEST(Scale, OfADirectionChangesNoRay) {
  const PackedSphereTree cube = tree_of(lattice_box({2, 2, 2}), 0);
  for (const double scale : {1.0, 0x1p-300, 0x1p300}) {
    Pose pose;
    pose.scale = scale;
    for (int power = -1070; power <= 1020; ++power) {
      const double speed = std::ldexp(1, power);
      const auto hit = cast_ray(cube, pose, {scale, 0.5 * scale, -scale}, {0, 0, speed});
      ASSERT_TRUE(hit) << scale << " 2^" << power;
      ASSERT_EQ(hit->point, (Vec{scale, 0.5 * scale, 0}));
      ASSERT_EQ(hit->along, scale / speed) << scale << " 2^" << power;  // infinite where no double says it
      ASSERT_FALSE(cast_ray(cube, pose, {scale, 0.5 * scale, -scale}, {0, 0, -speed})) << scale << " 2^" << power;
      const double half = 0.5 * scale / speed;
      if (half > 0 && std::isfinite(half)) {
        ASSERT_FALSE(cast_ray(cube, pose, {scale, 0.5 * scale, -scale}, {0, 0, speed}, half)) << power;
      }
    }
  }
}

}  // namespace
}  // namespace orchard::runtime
