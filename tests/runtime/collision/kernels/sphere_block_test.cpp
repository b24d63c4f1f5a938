// The inner loop over spheres: the compiler's vectors against one number at a time, bit for bit, and the definition.
#include "collision/kernels/sphere_block.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "every_machine.h"
#include "orchard/runtime/pose.h"
#include "support.h"

namespace orchard::runtime::detail {
namespace {

using test::Draw;
using test::on_every_machine;

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
    block.link[i] = draw.bits() % 2 == 0 ? kLeafBit : 3;
  }
  return block;
}

struct BlockCase {
  SiblingBlock rows, lanes;
  BlockPair pair;
  Placement placement;
  LevelState level;
};

void make(Draw& draw, BlockCase& c) {
  const auto row_count = static_cast<std::uint32_t>(1 + draw.bits() % 8);
  const auto lane_count = static_cast<std::uint32_t>(1 + draw.bits() % 8);
  c.rows = random_block(draw, row_count);
  c.lanes = random_block(draw, lane_count);
  const auto begin = static_cast<std::uint32_t>(draw.bits() % row_count);
  c.pair = {&c.rows,    &c.lanes,
            begin,      static_cast<std::uint32_t>(begin + 1 + draw.bits() % (row_count - begin)),
            lane_count, draw.bits() % 2 == 0};
  const Pose pose = draw.pose(draw.uniform(0, 2));
  c.placement.scale = draw.bits() % 2 == 0 ? 1.0f : static_cast<float>(draw.uniform(0.5, 2));
  for (std::size_t i = 0; i < 9; ++i) {
    c.placement.rotation[i] = static_cast<float>(pose.rotation[i]) * c.placement.scale;
  }
  for (std::size_t i = 0; i < 3; ++i) c.placement.translation[i] = static_cast<float>(pose.translation[i]);
  c.placement.slack = 1e-6f;
  c.level.min_excess.fill(std::numeric_limits<float>::infinity());
  c.level.row_radius.fill(0);
  c.level.lane_radius.fill(0.25f);
  c.level.best_inner = draw.bits() % 4 == 0 ? std::numeric_limits<float>::infinity() : 0.5f;
  c.level.best_leaf = draw.bits() % 4 == 0 ? std::numeric_limits<float>::infinity() : 0.75f;
}

TEST(SphereBlock, GivesTheSameBitsWithAndWithoutVectors) {
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Draw draw(seed);
    BlockCase c;
    make(draw, c);
    LevelState plain_level = c.level;
    BlockHits plain_hits;
    test::ask_portably([&] { test_block(c.pair, c.placement, plain_level, plain_hits); });
    on_every_machine([&] {
      LevelState level = c.level;
      BlockHits hits;
      test_block(c.pair, c.placement, level, hits);
      ASSERT_EQ(hits.meeting, plain_hits.meeting) << seed;
      ASSERT_EQ(hits.leaves, plain_hits.leaves) << seed;
      ASSERT_EQ(hits.improving, plain_hits.improving) << seed;
      for (std::uint32_t r = c.pair.row_begin; r < c.pair.row_end; ++r) {
        ASSERT_EQ(std::memcmp(&hits.square[r], &plain_hits.square[r], sizeof hits.square[r]), 0) << seed;
      }
      ASSERT_EQ(level.min_excess, plain_level.min_excess) << seed;
      ASSERT_EQ(level.row_radius, plain_level.row_radius) << seed;
      ASSERT_EQ(level.lane_radius, plain_level.lane_radius) << seed;
    });
    if (HasFatalFailure()) return;
  }
}

TEST(SphereBlock, FindsTheMeetingPairsTheirKindAndWhichMayImprove) {
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    Draw draw(seed);
    BlockCase c;
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
        const double scale = double{c.placement.scale};
        const double ls = c.pair.lanes_are_second ? scale : 1, rs = c.pair.lanes_are_second ? 1 : scale;
        Vec3 p = {c.lanes.x[l], c.lanes.y[l], c.lanes.z[l]}, q = {c.rows.x[r], c.rows.y[r], c.rows.z[r]};
        Vec3 moved = c.pair.lanes_are_second ? p : q;
        const Vec3 still = c.pair.lanes_are_second ? q : p, v = moved;
        for (std::size_t i = 0; i < 3; ++i) {
          moved[i] = double{c.placement.translation[i]};
          for (std::size_t j = 0; j < 3; ++j) moved[i] += double{c.placement.rotation[3 * i + j]} * v[j];
        }
        const double distance = std::hypot(moved[0] - still[0], moved[1] - still[1], moved[2] - still[2]);
        const double reach = ls * double{c.lanes.radius[l]} + rs * double{c.rows.radius[r]} + double{c.placement.slack};
        ASSERT_EQ(meets, distance <= reach) << seed;  // no case is so close that rounding would matter
        ASSERT_EQ(leaves, meets && (c.lanes.link[l] & c.rows.link[r] & kLeafBit) != 0) << seed;
        if (!meets) least = std::min(least, distance * distance - reach * reach);
        const double best = double{leaves ? c.level.best_leaf : c.level.best_inner};
        const double bound = std::min(ls * double{c.lanes.error[l]} + rs * double{c.rows.error[r]},
                                      distance + ls * double{c.lanes.depth[l]} + rs * double{c.rows.depth[r]});
        ASSERT_TRUE(improves || !meets || bound >= best - 1e-6) << seed;
        ASSERT_TRUE(!improves || bound < std::max(c.level.best_leaf, c.level.best_inner) + 1e-6) << seed;
      }
    }
    const float excess = *std::min_element(c.level.min_excess.begin(), c.level.min_excess.end());
    ASSERT_TRUE(!std::isfinite(least) || std::fabs(double{excess} - least) < 1e-5) << seed;
  }
}

// Where bodies are so large that even the place of unused lanes is within reach.
TEST(SphereBlock, NeverReportsUnusedLanes) {
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw draw(seed);
    BlockCase c;
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
    c.placement.scale = 1;
    BlockHits hits;
    for (const bool portable : {false, true}) {
      const test::OnMachine chosen(portable ? Machine::portable : best_machine());
      test_block(c.pair, c.placement, c.level, hits);
      const std::uint64_t used = (std::uint64_t{1} << c.pair.lane_count) - 1;
      ASSERT_EQ(hits.meeting & ~(used * 0x0101010101010101u), 0u) << seed;
      ASSERT_EQ((hits.leaves | hits.improving) & ~hits.meeting, 0u) << seed;
    }
  }
}

}  // namespace
}  // namespace orchard::runtime::detail
