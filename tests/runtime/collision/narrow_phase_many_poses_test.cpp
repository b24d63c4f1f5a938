#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies.h"
#include "math/triangle_pair.h"
#include "orchard/runtime/narrow_phase.h"
#include "support/query_of_trees.h"

// Ten thousand poses, random and around the first contact, against every pair of triangles.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;
using detail::TrianglePoints;

struct Box {
  Vec3 low, high;
  friend bool apart(const Box& a, const Box& b) {
    return a.high[0] < b.low[0] || b.high[0] < a.low[0] || a.high[1] < b.low[1] || b.high[1] < a.low[1] ||
           a.high[2] < b.low[2] || b.high[2] < a.low[2];
  }
};

Box box_of(const TrianglePoints& t) {
  Box b{t[0], t[0]};
  for (const Vec3& p : t) {
    for (std::size_t i = 0; i < 3; ++i) b.low[i] = std::min(b.low[i], p[i]), b.high[i] = std::max(b.high[i], p[i]);
  }
  return b;
}

struct Shape {
  explicit Shape(const PackedSphereTree& tree) {
    for (const auto& t : tree.triangles) {
      TrianglePoints points{};
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t i = 0; i < 3; ++i) points[k][i] = double{tree.vertices[t[k]][i]};
      }
      triangles.push_back(points);
      boxes.push_back(box_of(points));
    }
  }
  std::vector<TrianglePoints> triangles;
  std::vector<Box> boxes;
};

// b moved into a's frame, exactly as far as its coordinates go: the exact test decides every pair whose boxes overlap.
bool touch(const Shape& a, const Shape& b, const Pose& relative) {
  for (const TrianglePoints& t : b.triangles) {
    TrianglePoints moved{};
    for (std::size_t k = 0; k < 3; ++k) moved[k] = transform(relative, t[k]);
    const Box box = box_of(moved);
    for (std::size_t i = 0; i < a.triangles.size(); ++i) {
      if (!apart(a.boxes[i], box) && detail::triangles_intersect(a.triangles[i], moved, nullptr)) return true;
    }
  }
  return false;
}

TEST(NarrowPhase, AgreesWithEveryPairOfTrianglesAtTenThousandPoses) {
  const std::vector<PackedSphereTree> trees = {build_tree(torus(14, 8, 1, 0.3), {.bounds = false}),
                                               build_tree(spikes(5, 12, 9), {.bounds = false}),
                                               build_tree(soup(11, 120), {.bounds = false})};
  std::vector<Shape> shapes;
  for (const auto& tree : trees) shapes.emplace_back(tree);
  int poses = 0, touching = 0, beyond = 0;
  for (std::uint64_t seed = 0; poses < 10000; ++seed) {
    Draw draw(seed);
    const std::size_t i = draw.bits() % trees.size(), j = draw.bits() % trees.size();
    test::OwnNarrowPhase query(trees[i], trees[j]);
    const double reach = trees[i].bounding_radius + trees[j].bounding_radius;
    const Vec way = draw.direction();
    Pose pose = draw.pose(0);
    pose.scale = seed % 3 == 0 ? draw.uniform(0.5, 2) : 1;
    const auto at = [&](double distance) {
      Pose moved = pose;
      for (std::size_t k = 0; k < 3; ++k) moved.translation[k] = distance * way[k];
      return moved;
    };
    double near = 0, far = 2.2 * reach;
    for (int step = 0; step < 45; ++step) {
      const double middle = (near + far) / 2;
      query.start({}, at(middle));
      (query.refine_exactly() == Answer::yes ? near : far) = middle;
    }
    for (int k = 0; k < 20; ++k, ++poses) {
      const double step = std::pow(10, draw.uniform(-12, -1)) * (k % 2 == 0 ? reach : -reach);
      const Pose b = k < 14 ? at(near + step) : at(draw.uniform(0, 1.2 * reach));
      query.start({}, b);
      const Answer quick = query.refine_exactly();
      query.start({}, b);
      while (!query.finished()) query.refine({.work = 1000});
      ASSERT_EQ(query.answer(), quick);
      const bool truth = touch(shapes[i], shapes[j], b);
      touching += truth;
      // The frame of the pair may be either body's: a rounding of 1e-15 can decide at 1e-12 from the contact.
      if (truth == (quick == Answer::yes)) continue;
      ++beyond;
      ASSERT_TRUE(k < 14 && std::fabs(step) < 1e-9 * reach) << seed << " " << k;
    }
  }
  EXPECT_GT(touching, 3000);
  EXPECT_LT(touching, 8000);
  EXPECT_LT(beyond, 5);
}

}  // namespace
}  // namespace orchard::runtime
