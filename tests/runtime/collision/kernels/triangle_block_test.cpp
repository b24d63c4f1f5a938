// The inner loops over triangles: the compiler's vectors against one number at a time, bit for bit, and the definition.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "collision/kernels/triangle_block.h"
#include "collision/support_map.h"
#include "every_machine.h"
#include "orchard/runtime/pose.h"
#include "placement.h"
#include "support.h"
#include "support/effort.h"

namespace orchard::runtime::detail {
namespace {

using test::Draw;
using test::on_every_machine;
using test::placement_of;

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

// What the compiler's vectors find against what is found one number at a time.
void expect_same_on_every_machine(const NodeBox& single, const ObbNodeBlock& lanes, float scale, float margin,
                                  std::uint64_t seed, BoxGaps& plain) {
  test::ask_portably([&] { box_gaps(single, lanes, scale, margin, plain); });
  on_every_machine([&] {
    BoxGaps gaps;
    box_gaps(single, lanes, scale, margin, gaps);
    ASSERT_EQ(std::memcmp(&gaps.gap, &plain.gap, sizeof plain.gap), 0) << seed;
    ASSERT_EQ(std::pair(gaps.used, gaps.meeting), std::pair(plain.used, plain.meeting)) << seed;
  });
}

#ifdef __MINGW32__
TEST(Machines, OfWindowsHaveNoVectorsThatTheStackOfGccDoesNotAlign) { EXPECT_EQ(best_machine(), Machine::base); }
#endif

TEST(NodeBox, GivesTheSameBitsWithAndWithoutVectorsAndNeverAGapAboveTheDistance) {
  int apart = 0, tight = 0;
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 300 * orchard::test::more(); ++seed) {
    Draw draw(seed);
    const PackedSphereTree a = random_triangles(draw, static_cast<std::uint32_t>(1 + draw.bits() % 12)),
                           b = random_triangles(draw, 30);
    Pose pose = draw.pose(draw.uniform(0, 3));
    pose.scale = draw.uniform(0.5, 2);
    const Placement placement = placement_of(pose, 10);
    const auto placed_a = test::placed_triangles(a, Pose{}), placed_b = test::placed_triangles(b, pose);
    const auto check = [&](const BoxGaps& gaps, const PackedSphereTree& lanes, const auto& placed, const auto& single) {
      for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
        ASSERT_EQ(gaps.used >> lane & 1, lanes.obb_nodes[1].radius[lane] >= 0 ? 1u : 0u);
        if ((gaps.used >> lane & 1) == 0) continue;
        ASSERT_EQ(gaps.meeting >> lane & 1, gaps.gap[lane] <= 0 ? 1u : 0u);
        const auto distance = test::surface_distance(single, test::triangles_below(lanes, kBlockWidth + lane, placed));
        ASSERT_LE(gaps.gap[lane], distance) << seed;
        apart += gaps.gap[lane] > 0;
        tight += distance > 0 && gaps.gap[lane] > 0.5 * static_cast<double>(distance);
      }
    };
    BoxGaps gaps;
    expect_same_on_every_machine(moved_back(node_box_at(a.obb_nodes[0], 0), placement), b.obb_nodes[1], placement.scale,
                                 placement.box_margin, seed, gaps);
    check(gaps, b, placed_b, placed_a);
    if (HasFatalFailure()) return;
    if (a.obb_nodes.size() < 2) continue;
    expect_same_on_every_machine(moved(node_box_at(b.obb_nodes[0], 0), placement), a.obb_nodes[1], 1,
                                 placement.box_margin, seed, gaps);
    check(gaps, a, placed_a, placed_b);
    if (HasFatalFailure()) return;
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

// The pairs that are taken until so many were.
std::uint64_t candidates(const LeafPair& pair, const Placement& placement, int enough = 1000) {
  std::uint64_t found = 0;
  int count = 0;
  const bool ended = each_candidate(pair, placement, [&](std::uint32_t lane, std::uint32_t row) {
    found |= std::uint64_t{1} << (kBlockWidth * row + lane);
    return ++count == enough;
  });
  EXPECT_EQ(ended, count == enough);
  return found;
}

std::uint64_t first_of(std::uint64_t found, int count) {
  std::uint64_t result = 0;
  for (; found != 0 && count > 0; --count, found &= found - 1) result |= found & (0 - found);
  return result;
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
    const TriangleBlock lanes = test::one_block(a), rows = test::one_block(b);
    const NodeBox lane_box = node_box_at(a.obb_nodes[0], 0), row_box = moved(node_box_at(b.obb_nodes[0], 0), placement);
    const LeafPair pair{lanes, rows, lane_box, row_box};
    std::uint64_t found = 0;
    test::ask_portably([&] { found = candidates(pair, placement); });
    on_every_machine([&] {
      ASSERT_EQ(candidates(pair, placement), found) << seed;
      const int enough = static_cast<int>(1 + seed % 3);
      ASSERT_EQ(candidates(pair, placement, enough), first_of(found, enough)) << seed;
    });
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
