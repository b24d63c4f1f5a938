// The inner loops: the compiler's vectors against one number at a time, bit for bit, and against the definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "machine.h"
#include "pair/support_map.h"
#include "support.h"
#include "tree/patch_block.h"
#include "tree/sphere_block.h"

namespace orchard::runtime::detail {
namespace {

using test::Draw;

// Runs `check` with the inner loops of every machine that this one can be.
template <typename Check>
void on_every_machine(const Check& check) {
  for (Machine m = Machine::base; m <= best_machine(); m = static_cast<Machine>(static_cast<int>(m) + 1)) {
    SCOPED_TRACE(static_cast<int>(m));
    use_machine(m);
    check();
  }
  use_machine(best_machine());
}

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
  c.placement.scale = draw.bits() % 2 == 0 ? 1.0f : static_cast<float>(draw.uniform(0.5, 2));
  for (std::size_t i = 0; i < 9; ++i) {
    c.placement.rotation[i] = static_cast<float>(pose.rotation[i]) * c.placement.scale;
  }
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
    BlockHits plain_hits;
    test_block_scalar(c.pair, c.placement, plain_level, plain_hits);
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
      ASSERT_EQ(level.least_excess, plain_level.least_excess) << seed;
      ASSERT_EQ(level.row_radius, plain_level.row_radius) << seed;
      ASSERT_EQ(level.lane_radius, plain_level.lane_radius) << seed;
    });
    if (HasFatalFailure()) return;
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
    c.placement.scale = 1;
    BlockHits hits;
    for (const auto test : {test_block, test_block_scalar}) {
      test(c.pair, c.placement, c.level, hits);
      const std::uint64_t used = (std::uint64_t{1} << c.pair.lane_count) - 1;
      ASSERT_EQ(hits.meeting & ~(used * 0x0101010101010101u), 0u) << seed;
      ASSERT_EQ((hits.leaves | hits.improving) & ~hits.meeting, 0u) << seed;
    }
  }
}

Placement placement_of(const Pose& pose, double size) {
  Placement p{};
  for (std::size_t i = 0; i < 9; ++i) {
    p.turn[i] = static_cast<float>(pose.rotation[i]);
    p.rotation[i] = static_cast<float>(pose.rotation[i] * pose.scale);
  }
  for (std::size_t i = 0; i < 3; ++i) p.translation[i] = static_cast<float>(pose.translation[i]);
  p.scale = static_cast<float>(pose.scale);
  p.margin = static_cast<float>(size * 128 * 0x1p-24);
  return p;
}

// A tree of few random triangles, flat ones, needles and points among them, not far from the origin.
PackedSphereTree random_triangles(Draw& draw, std::uint32_t count) {
  PackedSphereTree tree;
  const double spread = draw.uniform(0.02, 1);
  const test::Vec middle = draw.direction();
  for (std::uint32_t i = 0; i < count; ++i) {
    const double size = draw.bits() % 8 == 0 ? 0 : draw.uniform(0, spread);
    const test::Vec center = draw.direction();
    for (int k = 0; k < 3; ++k) {
      const test::Vec d = draw.direction();
      auto& vertex = tree.vertices.emplace_back();
      for (std::size_t j = 0; j < 3; ++j) {
        vertex[j] = static_cast<float>(0.2 * middle[j] + spread * center[j] + size * d[j]);
      }
    }
    tree.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  index_triangles(tree);
  return tree;
}

std::vector<test::Triangle> triangles_below(const PackedSphereTree& tree, std::uint32_t node,
                                            const std::vector<test::Triangle>& placed) {
  const std::uint32_t child = tree.patches[node / kBlockWidth].child[node % kBlockWidth];
  std::vector<test::Triangle> result;
  if (child & kLeafBit) {
    for (const std::uint32_t t : tree.triangle_blocks[child & ~kLeafBit].triangle) {
      if (t != kNoTriangle) result.push_back(placed[t]);
    }
    return result;
  }
  for (std::uint32_t lane = 0; lane < kBlockWidth && tree.patches[child].radius[lane] >= 0; ++lane) {
    const auto more = triangles_below(tree, child * kBlockWidth + lane, placed);
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

TEST(PatchBlock, GivesTheSameBitsWithAndWithoutVectorsAndNeverAGapAboveTheDistance) {
  int apart = 0, tight = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Draw draw(seed);
    const PackedSphereTree a = random_triangles(draw, static_cast<std::uint32_t>(1 + draw.bits() % 12)),
                           b = random_triangles(draw, 30);
    Pose pose = draw.pose(draw.uniform(0, 3));
    pose.scale = draw.uniform(0.5, 2);
    const Placement placement = placement_of(pose, 10);
    const Patch single = patch_at(a.patches[0], 0);
    PatchGaps gaps, plain, still, plain_still;
    patch_gaps_scalar(single, b.patches[1], &placement, placement.margin, plain);
    patch_gaps_scalar(single, b.patches[1], nullptr, placement.margin, plain_still);
    on_every_machine([&] {
      patch_gaps(single, b.patches[1], &placement, placement.margin, gaps);
      patch_gaps(single, b.patches[1], nullptr, placement.margin, still);
      constexpr std::size_t lanes = offsetof(PatchGaps, used);
      ASSERT_EQ(std::memcmp(&gaps, &plain, lanes), 0) << seed;
      ASSERT_EQ(std::memcmp(&still, &plain_still, lanes), 0) << seed;
      ASSERT_EQ(std::pair(gaps.used, gaps.meeting), std::pair(plain.used, plain.meeting));
      ASSERT_EQ(std::pair(still.used, still.meeting), std::pair(plain_still.used, plain_still.meeting));
    });
    if (HasFatalFailure()) return;
    const auto placed = test::placed_triangles(b, pose), others = test::placed_triangles(a, Pose{});
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      ASSERT_EQ(gaps.used >> lane & 1, b.patches[1].radius[lane] >= 0 ? 1u : 0u);
      if ((gaps.used >> lane & 1) == 0) continue;
      ASSERT_EQ(gaps.meeting >> lane & 1, gaps.gap[lane] <= 0 ? 1u : 0u);
      const auto distance = test::surface_distance(others, triangles_below(b, kBlockWidth + lane, placed));
      ASSERT_LE(gaps.gap[lane], distance) << seed;
      apart += gaps.gap[lane] > 0;
      tight += distance > 0 && gaps.gap[lane] > 0.5 * static_cast<double>(distance);
    }
  }
  EXPECT_GT(apart, 300);
  EXPECT_GT(tight, 300);
}

TEST(SupportMap, CoversEveryPointInEveryDirection) {
  double worst = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    Draw draw(seed);
    const PackedSphereTree tree = random_triangles(draw, 30);
    Vec3 u = draw.direction();
    if (seed % 4 == 0) u[seed % 3] = 0;
    if (seed % 8 == 0) u[seed % 5 % 3] = u[(seed + 1) % 3];
    const Support support = support_along(tree.supports, u);
    double most = -1e300, size = 0;
    for (const auto& v : tree.vertices) {
      most = std::max(most, u[0] * v[0] + u[1] * v[1] + u[2] * v[2]);
      size = std::max(size, double{std::hypot(v[0], v[1], v[2])});
    }
    ASSERT_GE(support.most, most - 1e-14) << seed;
    worst = std::max(worst, (support.most - most) / size);
    ASSERT_NEAR(u[0] * support.point[0] + u[1] * support.point[1] + u[2] * support.point[2], support.most, 1e-9);
  }
  EXPECT_LT(worst, 0.1);
}

TEST(TriangleBlock, KeepsEveryPairThatMeetsAndGivesTheSameWithoutVectors) {
  int kept = 0, dropped = 0, meeting = 0;
  for (std::uint64_t seed = 0; seed < 8000; ++seed) {
    Draw draw(seed);
    const auto draw_count = [&draw] { return static_cast<std::uint32_t>(1 + draw.bits() % 8); };
    const PackedSphereTree a = random_triangles(draw, draw_count()), b = random_triangles(draw, draw_count());
    Pose pose = draw.pose(draw.uniform(0, 0.5));
    if (seed % 2 == 0) pose.scale = draw.uniform(0.25, 4);
    const Placement placement = placement_of(pose, 10);
    const TriangleBlock &lanes = a.triangle_blocks[0], &rows = b.triangle_blocks[0];
    const LeafPair pair{lanes, rows, patch_at(a.patches[0], 0), moved(patch_at(b.patches[0], 0), placement)};
    const std::uint64_t found = triangle_candidates_scalar(pair, placement);
    on_every_machine([&] { ASSERT_EQ(triangle_candidates(pair, placement), found) << seed; });
    if (HasFatalFailure()) return;
    for (std::uint32_t r = 0; r < kBlockWidth; ++r) {
      for (std::uint32_t l = 0; l < kBlockWidth; ++l) {
        const bool candidate = found >> (8 * r + l) & 1;
        if (rows.triangle[r] == kNoTriangle || lanes.triangle[l] == kNoTriangle) {
          ASSERT_FALSE(candidate) << seed;
          continue;
        }
        const bool meet = triangles_intersect(points_of(lanes, l), moved_points_of(rows, r, pose), nullptr);
        ASSERT_TRUE(candidate || !meet) << seed;
        (candidate ? kept : dropped) += 1;
        meeting += meet;
      }
    }
  }
  EXPECT_GT(meeting, 500);
  EXPECT_GT(dropped, kept);
  EXPECT_LT(kept, 2 * meeting);  // the filter leaves little to the exact test
}

}  // namespace
}  // namespace orchard::runtime::detail
