// The inner loops: the compiler's vectors against one number at a time, bit for bit, and against the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sphere_block.h"
#include "support.h"
#include "triangle_block.h"

namespace orchard::runtime::detail {
namespace {

using test::Draw;

SiblingBlock random_block(Draw& draw, std::uint32_t used) {
  SiblingBlock block;
  block.radius.fill(-1);
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) {  // unused lanes hold rubbish but for the radius
    block.x[i] = static_cast<float>(draw.uniform(-2, 2));
    block.y[i] = static_cast<float>(draw.uniform(-2, 2));
    block.z[i] = static_cast<float>(draw.uniform(-2, 2));
    if (i < used) block.radius[i] = static_cast<float>(draw.uniform(0, 1.5));
    block.error[i] = static_cast<float>(draw.uniform(0, 1));
    block.depth[i] = static_cast<float>(draw.uniform(-1, 1));
    if (draw.bits() % 8 == 0) block.error[i] = block.depth[i] = std::numeric_limits<float>::infinity();
    block.count[i] = draw.bits() % 2 == 0 ? kLeafBit : 3;
  }
  return block;
}

struct Case {
  SiblingBlock rows, lanes;
  BlockPair pair;
  Placement placement;
  LevelState level;
};

void make(Draw& draw, Case& c) {
  const auto row_count = static_cast<std::uint32_t>(1 + draw.bits() % 8);
  const auto lane_count = static_cast<std::uint32_t>(1 + draw.bits() % 8);
  c.rows = random_block(draw, row_count);
  c.lanes = random_block(draw, lane_count);
  const auto begin = static_cast<std::uint32_t>(draw.bits() % row_count);
  c.pair = {&c.rows,    &c.lanes,
            begin,      static_cast<std::uint32_t>(begin + 1 + draw.bits() % (row_count - begin)),
            lane_count, draw.bits() % 2 == 0};
  const Pose pose = draw.pose(draw.uniform(0, 2));
  for (std::size_t i = 0; i < 9; ++i) c.placement.rotation[i] = static_cast<float>(pose.rotation[i]);
  for (std::size_t i = 0; i < 3; ++i) c.placement.translation[i] = static_cast<float>(pose.translation[i]);
  c.placement.slack = 1e-6f;
  c.level.least_excess.fill(std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()) - 1);
  c.level.row_radius.fill(0);
  c.level.lane_radius.fill(0.25f);
  c.level.best_inner = draw.bits() % 4 == 0 ? std::numeric_limits<float>::infinity() : 0.5f;
  c.level.best_leaf = draw.bits() % 4 == 0 ? std::numeric_limits<float>::infinity() : 0.75f;
}

TEST(SphereBlock, GivesTheSameBitsWithAndWithoutVectors) {
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Draw draw(seed);
    Case c;
    make(draw, c);
    LevelState plain_level = c.level;
    BlockHits hits, plain_hits;
    test_block(c.pair, c.placement, c.level, hits);
    test_block_scalar(c.pair, c.placement, plain_level, plain_hits);
    ASSERT_EQ(hits.meeting, plain_hits.meeting) << seed;
    ASSERT_EQ(hits.leaves, plain_hits.leaves) << seed;
    ASSERT_EQ(hits.improving, plain_hits.improving) << seed;
    for (std::uint32_t r = c.pair.row_begin; r < c.pair.row_end; ++r) {
      ASSERT_EQ(std::memcmp(&hits.square[r], &plain_hits.square[r], sizeof hits.square[r]), 0) << seed;
    }
    ASSERT_EQ(c.level.least_excess, plain_level.least_excess) << seed;
    ASSERT_EQ(c.level.row_radius, plain_level.row_radius) << seed;
    ASSERT_EQ(c.level.lane_radius, plain_level.lane_radius) << seed;
  }
}

TEST(SphereBlock, FindsTheMeetingPairsTheirKindAndWhichMayImprove) {
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Draw draw(seed);
    Case c;
    make(draw, c);
    BlockHits hits;
    test_block(c.pair, c.placement, c.level, hits);
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t r = 0; r < 8; ++r) {
      for (std::uint32_t l = 0; l < 8; ++l) {
        const bool meets = hits.meeting >> (8 * r + l) & 1, leaves = hits.leaves >> (8 * r + l) & 1;
        const bool improves = hits.improving >> (8 * r + l) & 1;
        if (r < c.pair.row_begin || r >= c.pair.row_end || l >= c.pair.lane_count) {
          ASSERT_FALSE(meets || leaves || improves) << seed;
          continue;
        }
        Vec3 p = {c.lanes.x[l], c.lanes.y[l], c.lanes.z[l]}, q = {c.rows.x[r], c.rows.y[r], c.rows.z[r]};
        Vec3 moved = c.pair.lanes_are_second ? p : q;
        const Vec3 still = c.pair.lanes_are_second ? q : p, v = moved;
        for (std::size_t i = 0; i < 3; ++i) {
          moved[i] = double{c.placement.translation[i]};
          for (std::size_t j = 0; j < 3; ++j) moved[i] += double{c.placement.rotation[3 * i + j]} * v[j];
        }
        const double distance = std::hypot(moved[0] - still[0], moved[1] - still[1], moved[2] - still[2]);
        const double reach = double{c.lanes.radius[l]} + c.rows.radius[r] + double{c.placement.slack};
        ASSERT_EQ(meets, distance <= reach) << seed;  // no case is so close that rounding would matter
        ASSERT_EQ(leaves, meets && (c.lanes.count[l] & c.rows.count[r] & kLeafBit) != 0) << seed;
        if (!meets) least = std::min(least, distance * distance - reach * reach);
        const double best = double{leaves ? c.level.best_leaf : c.level.best_inner};
        const double bound =
            std::min(double{c.lanes.error[l]} + c.rows.error[r], distance + double{c.lanes.depth[l]} + c.rows.depth[r]);
        ASSERT_TRUE(improves || !meets || bound >= best - 1e-6) << seed;
        ASSERT_TRUE(!improves || bound < std::max(c.level.best_leaf, c.level.best_inner) + 1e-6) << seed;
      }
    }
    const auto bits = *std::min_element(c.level.least_excess.begin(), c.level.least_excess.end()) + 1;
    ASSERT_TRUE(!std::isfinite(least) || std::fabs(double{std::bit_cast<float>(bits)} - least) < 1e-5) << seed;
  }
}

// Where bodies are so large that even the place of unused lanes is within reach.
TEST(SphereBlock, NeverReportsUnusedLanes) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw draw(seed);
    Case c;
    make(draw, c);
    for (SiblingBlock* block : {&c.rows, &c.lanes}) {
      for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
        for (auto* v : {&block->x, &block->y, &block->z, &block->radius}) {
          (*v)[i] = (*v)[i] == -1 ? -1 : kCoordinateLimit * static_cast<float>(draw.uniform(0, 1));
        }
      }
    }
    for (float& t : c.placement.translation) t = 2.5f * kCoordinateLimit;
    c.placement.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    BlockHits hits;
    for (const auto test : {test_block, test_block_scalar}) {
      test(c.pair, c.placement, c.level, hits);
      const std::uint64_t used = (std::uint64_t{1} << c.pair.lane_count) - 1;
      ASSERT_EQ(hits.meeting & ~(used * 0x0101010101010101u), 0u) << seed;
      ASSERT_EQ((hits.leaves | hits.improving) & ~hits.meeting, 0u) << seed;
    }
  }
}

struct Leaf {
  PackedSphereTree tree;
  Ball ball;
};

Leaf random_leaf(Draw& draw, const Pose& pose) {
  Leaf leaf;
  const auto count = static_cast<std::uint32_t>(1 + draw.bits() % 4);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double size = draw.bits() % 8 == 0 ? 0 : draw.uniform(0, 1);
    const test::Vec center = draw.direction();
    for (int k = 0; k < 3; ++k) {
      const test::Vec d = draw.direction();
      auto& vertex = leaf.tree.vertices.emplace_back();
      for (std::size_t j = 0; j < 3; ++j) vertex[j] = static_cast<float>(0.7 * center[j] + size * d[j]);
    }
    leaf.tree.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    leaf.tree.leaf_triangles.push_back(i);
  }
  leaf.ball = {transform(pose, {0.1, 0, -0.1}), draw.uniform(0.2, 1)};
  return leaf;
}

TEST(TriangleBlock, KeepsEveryPairThatMeetsInBothBallsAndGivesTheSameWithoutVectors) {
  int kept = 0, dropped = 0, meeting = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Draw draw(seed);
    const Pose pose = draw.pose(draw.uniform(0, 2));
    const Leaf a = random_leaf(draw, Pose{}), b = random_leaf(draw, pose);
    TriangleBlock lanes, rows;
    load_block(a.tree, a.tree.leaf_triangles.data(), static_cast<std::uint32_t>(a.tree.triangles.size()), nullptr,
               lanes);
    load_block(b.tree, b.tree.leaf_triangles.data(), static_cast<std::uint32_t>(b.tree.triangles.size()), &pose, rows);
    const TriangleBlockPair pair{rows, lanes, 0, rows.count, b.ball, a.ball, 8};
    const std::uint32_t found = candidates(pair);
    ASSERT_EQ(found, candidates_scalar(pair)) << seed;
    std::uint32_t by_row = 0;
    for (std::uint32_t r = 0; r < rows.count; ++r) by_row |= candidates({rows, lanes, r, r + 1, b.ball, a.ball, 8});
    ASSERT_EQ(found, by_row) << seed;
    for (std::uint32_t r = 0; r < rows.count; ++r) {
      for (std::uint32_t l = 0; l < lanes.count; ++l) {
        Vec3 common{};
        const bool meet = triangles_intersect(lanes.points(l), rows.points(r), &common);
        const auto in_ball = [&common](const Ball& ball) {
          return std::hypot(common[0] - ball.center[0], common[1] - ball.center[1], common[2] - ball.center[2]) <=
                 ball.radius;
        };
        const bool candidate = found >> (4 * r + l) & 1;
        ASSERT_TRUE(candidate || !(meet && in_ball(a.ball) && in_ball(b.ball))) << seed;
        (candidate ? kept : dropped) += 1;
        meeting += meet;
      }
    }
    for (std::uint32_t r = 0; r < rows.count; ++r) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& v = b.tree.vertices[b.tree.triangles[r][k]];
        ASSERT_EQ(rows.points(r)[k], transform(pose, {v[0], v[1], v[2]}));
      }
    }
  }
  EXPECT_GT(meeting, 200);
  EXPECT_GT(dropped, kept);
}

}  // namespace
}  // namespace orchard::runtime::detail
