// The inner loops of rays, points and moving ball slabs: the compiler's vectors against one number at a time, bit for
// bit, and what they promise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bodies.h"
#include "collision/kernels/obb_node_block.h"
#include "collision/kernels/obb_node_time.h"
#include "collision/kernels/point_block.h"
#include "collision/kernels/ray_block.h"
#include "collision/kernels/segment_block.h"
#include "collision/segment_meets.h"
#include "collision/triangle_distance.h"
#include "every_machine.h"
#include "support/effort.h"

namespace orchard::runtime::detail {
namespace {

using test::Draw;
using test::on_every_machine;

template <typename T>
bool same_bits(const T& p, const T& q) {
  return std::memcmp(&p, &q, sizeof p) == 0;
}

Placement still(double size) {
  Placement p{};
  p.rotation = p.turn = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  p.scale = 1;
  p.margin = static_cast<float>(std::max(size * 128 * 0x1p-24, 1e-15));
  const int exponent = 1 + std::ilogb(size);
  p.unit = static_cast<float>(std::ldexp(1, -exponent)), p.whole = static_cast<float>(std::ldexp(1, exponent));
  return p;
}

TEST(PointBlock, BoundsTheDistanceFromBelowAndCloselyAtEveryScaleOnEveryMachine) {
  on_every_machine([] {
    int close = 0, all = 0;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
      const double scale = std::ldexp(1, static_cast<int>(seed % 4) * 30 - 45);
      const auto tree = test::build_tree(
          test::scaled(seed % 2 == 0 ? test::torus(12, 7, 1, 0.3) : test::soup(seed, 40), scale), {.bounds = false});
      Draw draw(seed);
      const Placement placement = still(4 * scale);
      for (const TriangleBlock& block : tree.triangle_blocks) {
        const std::array<float, 3> p = {static_cast<float>(draw.uniform(-1.5, 1.5) * scale),
                                        static_cast<float>(draw.uniform(-1.5, 1.5) * scale),
                                        static_cast<float>(draw.uniform(-0.5, 0.5) * scale)};
        PointGaps lower, plain;
        point_gaps(p, block, placement, lower);
        point_gaps_scalar(p, block, placement, plain);
        ASSERT_TRUE(same_bits(lower, plain)) << seed;
        for (std::uint32_t i = 0; i < kBlockWidth && block.triangle[i] != kNoTriangle; ++i) {
          const double truth = nearest_points(Vec3{p[0], p[1], p[2]}, points_of(block, i)).distance;
          ASSERT_LE(double{lower[i]}, truth) << seed;
          close += double{lower[i]} > truth - 3 * double{placement.margin} - 1e-3 * truth;
          ++all;
        }
      }
    }
    EXPECT_GT(close, all * 9 / 10);
  });
}

TEST(SegmentBlock, BoundsTheDistanceFromBelowAndCloselyAtEveryScaleOnEveryMachine) {
  on_every_machine([] {
    int close = 0, all = 0;
    const std::uint64_t begin = orchard::test::first_seed();
    for (std::uint64_t seed = begin; seed < begin + 120 * orchard::test::more(); ++seed) {
      const double scale = std::ldexp(1, static_cast<int>(seed % 4) * 30 - 45);
      const auto tree = test::build_tree(
          test::scaled(seed % 2 == 0 ? test::torus(12, 7, 1, 0.3) : test::soup(seed, 40), scale), {.bounds = false});
      Draw draw(seed);
      const Placement placement = still(4 * scale);
      const double reach = seed % 3 == 0 ? 0 : draw.uniform(0, 1);
      for (const TriangleBlock& block : tree.triangle_blocks) {
        std::array<float, 3> p{}, q{};
        for (std::size_t i = 0; i < 3; ++i) {
          const double middle = draw.uniform(-1.5, 1.5), half = reach * draw.uniform(-1, 1);
          p[i] = static_cast<float>((middle - half) * scale), q[i] = static_cast<float>((middle + half) * scale);
        }
        if (seed % 5 == 0) {  // along an edge of the first triangle, and in its plane
          for (std::size_t i = 0; i < 3; ++i) q[i] = p[i] + 0.5f * (block.corner[1][i][0] - block.corner[0][i][0]);
        }
        SegmentGaps lower, plain;
        segment_gaps(p, q, block, placement, lower);
        segment_gaps_scalar(p, q, block, placement, plain);
        ASSERT_TRUE(same_bits(lower, plain)) << seed;
        for (std::uint32_t i = 0; i < kBlockWidth && block.triangle[i] != kNoTriangle; ++i) {
          const Vec3 from = {p[0], p[1], p[2]}, to = {q[0], q[1], q[2]};
          const TrianglePoints triangle = points_of(block, i);
          Vec3 common{};
          const double truth =
              segment_meets(from, to, triangle, common) ? 0 : nearest_points(from, to, triangle).distance;
          ASSERT_LE(double{lower[i]}, truth + kParallelError * 8 * scale) << seed;
          close += double{lower[i]} > truth - 6 * double{placement.margin} - 1e-3 * truth;
          ++all;
        }
      }
    }
    EXPECT_GT(close, all * 9 / 10);
  });
}

TEST(RayBlock, KeepsEveryTriangleAndObbNodeOnTheRayOnEveryMachine) {
  on_every_machine([] {
    long kept = 0, tested = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      const double scale = std::ldexp(1, static_cast<int>(seed % 4) * 30 - 45);
      const auto tree = test::build_tree(
          test::scaled(seed % 2 == 0 ? test::torus(20, 9, 1, 0.3) : test::soup(seed, 60), scale), {.bounds = false});
      Draw draw(seed);
      // Through a random point of a random triangle.
      const auto& t = tree.triangles[draw.bits() % tree.triangles.size()];
      const double u = draw.uniform(0, 1), v = draw.uniform(0, 1 - u);
      const auto& way = draw.direction();
      Vec3 target{};
      for (std::size_t i = 0; i < 3; ++i) {
        target[i] = (1 - u - v) * double{tree.vertices[t[0]][i]} + u * double{tree.vertices[t[1]][i]} +
                    v * double{tree.vertices[t[2]][i]};
      }
      FloatRay ray;
      const double at = target[0] * way[0] + target[1] * way[1] + target[2] * way[2];
      for (std::size_t i = 0; i < 3; ++i) {
        ray.origin[i] = static_cast<float>(target[i] - at * way[i]);
        ray.direction[i] = static_cast<float>(way[i]);
      }
      ray.margin = static_cast<float>(std::max(4 * scale * 48 * 0x1p-24, 1e-15));
      const auto begin = static_cast<float>(-2 * scale), end = static_cast<float>(2 * scale);
      for (std::size_t b = 0; b < tree.obb_nodes.size(); ++b) {
        RayEntries entries, plain;
        const std::uint32_t met = ray_obb_nodes(ray, tree.obb_nodes[b], begin, end, entries);
        ASSERT_EQ(met, ray_obb_nodes_scalar(ray, tree.obb_nodes[b], begin, end, plain)) << seed;
        ASSERT_TRUE(same_bits(entries, plain)) << seed;
        for (std::uint32_t lane = 0; lane < kBlockWidth && tree.obb_nodes[b].radius[lane] >= 0; ++lane) {
          const ObbNodeBlock& slab = tree.obb_nodes[b];
          const Vec3 from = {target[0] - double{slab.x[lane]}, target[1] - double{slab.y[lane]},
                             target[2] - double{slab.z[lane]}};
          const double height =
              from[0] * double{slab.nx[lane]} + from[1] * double{slab.ny[lane]} + from[2] * double{slab.nz[lane]};
          const bool holds = std::hypot(from[0], from[1], from[2]) <= double{slab.radius[lane]} &&
                             std::fabs(height) <= double{slab.height[lane]};
          ASSERT_TRUE(!holds || (met >> lane & 1)) << seed;
          if (holds) {
            ASSERT_LE(double{entries[lane]}, at + 1e-6 * scale) << seed;
          }
        }
      }
      for (const TriangleBlock& block : tree.triangle_blocks) {
        const std::uint32_t some = ray_triangles(ray, block).some;
        ASSERT_EQ(some, ray_triangles_scalar(ray, block).some) << seed;
        for (std::uint32_t lane = 0; lane < kBlockWidth && block.triangle[lane] != kNoTriangle; ++lane) {
          const bool aimed = &tree.triangles[block.triangle[lane]] == &t;
          ASSERT_TRUE(!aimed || (some >> lane & 1)) << seed;
          if (seed % 4 != 0) kept += some >> lane & 1, ++tested;  // margins are no smaller for tiny bodies
        }
      }
    }
    EXPECT_LT(kept, tested / 10);
  });
}

ObbNodeBlock random_obb_nodes(Draw& draw) {
  ObbNodeBlock lanes;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
    const auto n = draw.direction();
    lanes.x[i] = static_cast<float>(draw.uniform(-3, 3)), lanes.y[i] = static_cast<float>(draw.uniform(-3, 3));
    lanes.z[i] = static_cast<float>(draw.uniform(-3, 3));
    lanes.nx[i] = static_cast<float>(n[0]), lanes.ny[i] = static_cast<float>(n[1]);
    lanes.nz[i] = static_cast<float>(n[2]);
    lanes.radius[i] = static_cast<float>(draw.uniform(0.01, 1));
    lanes.height[i] = lanes.radius[i] * static_cast<float>(draw.uniform(0, 0.3));
  }
  lanes.radius[7] = -1;
  return lanes;
}

Closing random_closing(Draw& draw, std::uint64_t seed) {
  Closing closing;
  const auto v = draw.direction(), a = draw.direction(), b = draw.direction();
  const double speed = draw.uniform(0, 4);
  for (std::size_t i = 0; i < 3; ++i) {
    closing.velocity[i] = static_cast<float>(speed * v[i]);
    closing.first.axis[i] = static_cast<float>(a[i]), closing.second.axis[i] = static_cast<float>(b[i]);
    closing.first.center[i] = static_cast<float>(draw.uniform(-0.5, 0.5));
    closing.second.center[i] = static_cast<float>(draw.uniform(-0.5, 0.5));
  }
  closing.first.spin = static_cast<float>(seed % 3 == 0 ? 0 : draw.uniform(0, 2));
  closing.second.spin = static_cast<float>(seed % 2 == 0 ? 0 : draw.uniform(0, 2));
  return closing;
}

// A place after some time of turning.
Vec3 turned(const Turning& t, const Vec3& p, double time) {
  const double angle = double{t.spin} * time;
  const Vec3 k = {double{t.axis[0]}, double{t.axis[1]}, double{t.axis[2]}},
             q = {p[0] - double{t.center[0]}, p[1] - double{t.center[1]}, p[2] - double{t.center[2]}};
  const double c = std::cos(angle), s = std::sin(angle), d = (k[0] * q[0] + k[1] * q[1] + k[2] * q[2]) * (1 - c);
  return Vec3{double{t.center[0]} + c * q[0] + s * (k[1] * q[2] - k[2] * q[1]) + d * k[0],
              double{t.center[1]} + c * q[1] + s * (k[2] * q[0] - k[0] * q[2]) + d * k[1],
              double{t.center[2]} + c * q[2] + s * (k[0] * q[1] - k[1] * q[0]) + d * k[2]};
}

// Until the time that is told, no two points of the ball slabs meet: corners of triangles in them, moved and turned.
TEST(ObbNodeTimes, AreNotLaterThanAnyContactOnEveryMachine) {
  on_every_machine([] {
    int met = 0, late = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      Draw draw(seed);
      const ObbNodeBlock lanes = random_obb_nodes(draw);
      const auto m = draw.direction();
      const ObbNode single = {
          0, 0, 0, static_cast<float>(m[0]), static_cast<float>(m[1]), static_cast<float>(m[2]), 0.5f, 0.1f};
      const Closing closing = random_closing(draw, seed);
      const Placement placement = still(8);
      ObbNodeTimes times, plain;
      obb_node_times(single, lanes, &placement, closing, placement.margin, times);
      obb_node_times_scalar(single, lanes, &placement, closing, placement.margin, plain);
      ASSERT_TRUE(same_bits(times.time, plain.time) && same_bits(times.x, plain.x)) << seed;
      ASSERT_EQ(times.used, 0x7fu);
      // As far as the axes go: the gap of two balls' centres along a line must not close before.
      for (std::uint32_t lane = 0; lane < 7; ++lane) {
        if (!(times.time[lane] > 0)) continue;
        ++late;
        const Vec3 p = {0, 0, 0}, q = {double{lanes.x[lane]}, double{lanes.y[lane]}, double{lanes.z[lane]}};
        const double last = std::min(double{times.time[lane]}, 3.0);
        for (int i = 0; i <= 30; ++i) {
          const double time = last * i / 30;
          const Vec3 at = turned(closing.first, p, time);
          Vec3 other = turned(closing.second, q, time);
          for (std::size_t k = 0; k < 3; ++k) other[k] += double{closing.velocity[k]} * time;
          const double apart = std::hypot(other[0] - at[0], other[1] - at[1], other[2] - at[2]);
          // Each holds at least the ball of its height around its centre.
          ASSERT_GT(apart, double{single.height} + double{lanes.height[lane]} - 1e-4) << seed << " " << lane;
          met += apart < 1;
        }
      }
    }
    EXPECT_GT(late, 500);
    EXPECT_GT(met, 20);
  });
}

}  // namespace
}  // namespace orchard::runtime::detail
