// The inner loops of rays, points and moving ball slabs: the compiler's vectors against one number at a time, bit for
// bit, and what they promise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "bodies.h"
#include "collision/kernels/box_time.h"
#include "collision/kernels/ray_block.h"
#include "collision/kernels/segment_block.h"
#include "collision/kernels/triangle_block.h"
#include "collision/segment_meets.h"
#include "collision/triangle_distance.h"
#include "every_machine.h"
#include "math/vector_functions.h"
#include "support/effort.h"

namespace orchard::runtime::detail {
namespace {

using test::ask_portably;
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
        ask_portably([&] { segment_gaps(p, q, block, placement, plain); });
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

TEST(RayBlock, FindsTheTriangleThatTheRayIsAimedAtOnEveryMachine) {
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
      const float size = static_cast<float>(scale);
      for (std::size_t i = 0; i < 3; ++i) {
        ray.origin[i] = static_cast<float>(target[i] - 2 * scale * way[i]);
        ray.direction[i] = static_cast<float>(way[i]);
      }
      ray.margin = static_cast<float>(std::max(4 * scale * 48 * 0x1p-24, 1e-15));
      const auto leaves_on_ray = [&] {
        std::vector<RayLeaf> leaves;
        RayWalk walk(ray, 0, 4 * size, tree.obb_nodes[0].child[0]);
        for (RayLeaf leaf = next_leaf(tree, walk); leaf.block != nullptr; leaf = next_leaf(tree, walk)) {
          leaves.push_back(leaf);
        }
        return leaves;
      };
      const std::vector<RayLeaf> leaves = leaves_on_ray();
      std::vector<RayLeaf> plain;
      ask_portably([&] { plain = leaves_on_ray(); });
      ASSERT_EQ(leaves.size(), plain.size()) << seed;
      bool found = false;
      for (std::size_t l = 0; l < leaves.size(); ++l) {
        ASSERT_EQ(leaves[l].block, plain[l].block) << seed;
        ASSERT_EQ(leaves[l].some, plain[l].some) << seed;
        ASSERT_EQ(leaves[l].sure, plain[l].sure) << seed;
        for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
          if ((leaves[l].some >> lane & 1) == 0) continue;
          found = found || &tree.triangles[leaves[l].block->triangle[lane]] == &t;
          kept += seed % 4 != 0;  // margins are no smaller for tiny bodies
        }
      }
      ASSERT_TRUE(found) << seed;
      if (seed % 4 != 0) tested += static_cast<long>(tree.triangles.size());
    }
    EXPECT_LT(kept, tested / 10);
  });
}

// Boxes that fill their balls as far as they can.
ObbNodeBlock random_obb_nodes(Draw& draw) {
  ObbNodeBlock lanes;
  for (std::uint32_t i = 0; i < kBlockWidth; ++i) {
    const Vec3 n = draw.direction(), other = draw.direction(), across = cross(n, other);
    const double size = length(across);
    for (auto [to, k] : {std::pair(&lanes.nx, 0), std::pair(&lanes.ny, 1), std::pair(&lanes.nz, 2)}) {
      (*to)[i] = static_cast<float>(n[static_cast<std::size_t>(k)]);
    }
    lanes.mx[i] = static_cast<float>(across[0] / size), lanes.my[i] = static_cast<float>(across[1] / size);
    lanes.mz[i] = static_cast<float>(across[2] / size);
    lanes.x[i] = static_cast<float>(draw.uniform(-3, 3)), lanes.y[i] = static_cast<float>(draw.uniform(-3, 3));
    lanes.z[i] = static_cast<float>(draw.uniform(-3, 3));
    lanes.radius[i] = static_cast<float>(draw.uniform(0.01, 1));
    lanes.height[i] = lanes.radius[i] * static_cast<float>(draw.uniform(0, 0.3));
    lanes.width[i] = lanes.length[i] = lanes.radius[i] * static_cast<float>(draw.uniform(0.3, 0.7));
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
    closing.single.axis[i] = static_cast<float>(a[i]), closing.lanes.axis[i] = static_cast<float>(b[i]);
    closing.single.center[i] = static_cast<float>(draw.uniform(-0.5, 0.5));
    closing.lanes.center[i] = static_cast<float>(draw.uniform(-0.5, 0.5));
  }
  closing.single.spin = static_cast<float>(seed % 3 == 0 ? 0 : draw.uniform(0, 2));
  closing.lanes.spin = static_cast<float>(seed % 2 == 0 ? 0 : draw.uniform(0, 2));
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

// A corner of a node's box, or its centre.
Vec3 point_of(const NodeBox& b, std::uint32_t number) {
  const std::array<float, 3> l = third_normal(b);
  const double h = number % 2 == 0 ? double{b.height} : -double{b.height},
               w = number / 2 % 2 == 0 ? double{b.width} : -double{b.width},
               d = number / 4 == 0 ? double{b.length} : -double{b.length};
  Vec3 result = {b.center[0], b.center[1], b.center[2]};
  for (std::size_t i = 0; i < 3 && number < 8; ++i) {
    result[i] += 0.999 * (h * double{b.n[i]} + w * double{b.m[i]} + d * double{l[i]});
  }
  return result;
}

// In the box and in its ball, as triangles are.
bool is_inside(const NodeBox& b, const Vec3& p) {
  const std::array<float, 3> l = third_normal(b);
  const Vec3 from = p - Vec3{b.center[0], b.center[1], b.center[2]};
  const auto along = [&from](const auto& u) {
    return std::fabs(from[0] * double{u[0]} + from[1] * double{u[1]} + from[2] * double{u[2]});
  };
  return length(from) <= double{b.radius} && along(b.n) <= double{b.height} && along(b.m) <= double{b.width} &&
         along(l) <= double{b.length};
}

// Until the time that is told, no corner and no centre of one box, moved and turned, is inside the other one.
TEST(BoxTimes, AreNotLaterThanAnyContactOnEveryMachine) {
  on_every_machine([] {
    int late = 0, met = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
      Draw draw(seed);
      const ObbNodeBlock lanes = random_obb_nodes(draw), others = random_obb_nodes(draw);
      NodeBox single = node_box_at(others, 0);
      single.center = {};
      Closing closing = random_closing(draw, seed);
      const Placement placement = still(8);
      closing.rounding = placement.margin;
      BoxTimes times, plain;
      box_times(single, lanes, 1, closing, placement.margin, times);
      ask_portably([&] { box_times(single, lanes, 1, closing, placement.margin, plain); });
      ASSERT_TRUE(same_bits(times.time, plain.time)) << seed;
      ASSERT_EQ(times.used, 0x7fu);
      for (std::uint32_t lane = 0; lane < 7; ++lane) {
        if (!(times.time[lane] > 0)) continue;
        ++late;
        const NodeBox box = node_box_at(lanes, lane);
        const double last = std::min(double{times.time[lane]}, 3.0);
        for (int i = 0; i <= 30; ++i) {
          const double time = last * i / 30;
          const Vec3 way = {time * double{closing.velocity[0]}, time * double{closing.velocity[1]},
                            time * double{closing.velocity[2]}};
          for (std::uint32_t k = 0; k < 9; ++k) {
            // Where the other one's point is in the frame that turns with the box.
            const Vec3 of_lane = turned(closing.lanes, point_of(box, k), time) + way;
            const Vec3 of_single = turned(closing.single, point_of(single, k), time) - way;
            const Vec3 in_single = turned(closing.single, of_lane, -time),
                       in_box = turned(closing.lanes, of_single, -time);
            ASSERT_FALSE(is_inside(box, point_of(box, k)) && is_inside(single, in_single)) << seed << " " << lane;
            ASSERT_FALSE(is_inside(single, point_of(single, k)) && is_inside(box, in_box)) << seed << " " << lane;
            met += length(of_lane) < 1;
          }
        }
      }
    }
    EXPECT_GT(late, 500);
    EXPECT_GT(met, 20);
  });
}

}  // namespace
}  // namespace orchard::runtime::detail
