// Fronts: the loops that they are made of, one number at a time and by every machine, and what a pair answers with one,
// step by step, against queries that know of nothing before.
#include "orchard/runtime/pair_front.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>

#include "allocation.h"
#include "bodies.h"
#include "collision/coherent_pair.h"
#include "collision/kernels/front_block.h"
#include "every_machine.h"
#include "orchard/runtime/collide.h"
#include "placement.h"
#include "support/effort.h"

namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

std::vector<PackedSphereTree> meshes() {
  std::vector<PackedSphereTree> result;
  for (Body& body : bodies()) result.push_back(std::move(body.tree));
  for (const Mesh& mesh : {torus(32, 16, 1, 0.3), spikes(3, 28, 21), soup(5, 400)}) result.push_back(build_tree(mesh));
  return result;
}

Pose turned_by(const Pose& pose, const Vec& axis, double angle) {
  const double s = std::sin(angle / 2);
  Pose result =
      compose(*pose_from_quaternion({std::cos(angle / 2), s * axis[0], s * axis[1], s * axis[2]}, {0, 0, 0}), pose);
  result.translation = pose.translation;
  return made_rigid(result).value_or(result);
}

// A pair that drifts and turns, slowly or fast, now and then jumps, and now and then is asked within a budget.
struct Journey {
  Journey(const std::vector<PackedSphereTree>& trees, std::uint64_t seed)
      : draw(seed), i(draw.bits() % trees.size()), j(draw.bits() % trees.size()) {
    reach = trees[i].bounding_radius + trees[j].bounding_radius;
    a = centered(trees[i], draw.pose(0));
    b = draw.pose(draw.uniform(0, 0.8) * reach);
    b.scale = seed % 5 == 0 ? 1.5 : 1;
    way = draw.direction(), axis = draw.direction();
    speed = reach * std::pow(10, draw.uniform(-4, -1.7)), spin = std::pow(10, draw.uniform(-4, -1.3));
  }
  void step(int number) {
    b = turned_by(b, axis, spin);
    for (std::size_t k = 0; k < 3; ++k) b.translation[k] += speed * way[k];
    double square = 0;
    for (const double x : b.translation) square += x * x;
    if (square > reach * reach) {  // back again
      way = draw.direction();
      for (std::size_t k = 0; k < 3; ++k) b.translation[k] *= 0.9;
    }
    if (number % 37 == 36) b = turned_by(b, draw.direction(), 1);
    if (number % 53 == 52) b.scale *= number % 2 == 0 ? 1.1 : 1 / 1.1;
    if (number % 29 == 28) way = draw.direction(), axis = draw.direction();
    if (number % 61 == 60) a = turned_by(a, draw.direction(), 0.3);
  }
  Draw draw;
  std::size_t i, j;
  double reach = 0, speed = 0, spin = 0;
  Pose a, b;
  Vec way{}, axis{};
};

TEST(PairFront, GivesTheAnswersOfFreshQueriesForLessWork) {
  const auto trees = meshes();
  std::vector<PreparedTree> prepared(trees.begin(), trees.end());
  std::vector<PairFront> fronts(2);
  Workspace workspace, fresh;
  std::uint64_t yes = 0, no = 0, work = 0, fresh_work = 0;
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 60 * orchard::test::more(); ++seed) {
    Journey journey(trees, seed);
    TreePair pair(prepared[journey.i], prepared[journey.j]);
    pair.use(&fronts[seed % 2]);
    for (int step = 0; step < 100; ++step) {
      journey.step(step);
      const Pose at = centered(trees[journey.j], journey.b);
      const Verdict again = collide_coherently(workspace, pair, journey.a, at);
      const TreePair other(prepared[journey.i], prepared[journey.j]);
      const Verdict truth = collide(fresh, other, journey.a, at);
      ASSERT_EQ(again.answer, truth.answer) << seed << " " << step;
      (again.answer == Answer::yes ? yes : no) += 1;
      work += again.work, fresh_work += truth.work;
      if (again.answer == Answer::no && step % 8 == 0) {
        ASSERT_LE(again.lower_bound, distance(fresh, other, journey.a, at).upper) << seed << " " << step;
      }
      if (again.answer == Answer::yes && step % 8 == 0) {  // the two that are named do meet
        const auto of_a = placed_triangles(trees[journey.i], journey.a), of_b = placed_triangles(trees[journey.j], at);
        ASSERT_LE(surface_distance({of_a[again.contact.triangle_a]}, {of_b[again.contact.triangle_b]}),
                  1e-9L * (1 + 3000))
            << seed << " " << step;
      }
    }
  }
  EXPECT_GT(yes, 1000u);
  EXPECT_GT(no, 1000u);
  EXPECT_LT(2 * work, fresh_work);
}

// A search that a budget ends says "maybe", and one with enough what is so; both leave a front that can be gone on
// with.
TEST(PairFront, GoesOnWhereABudgetEndedIt) {
  const auto trees = meshes();
  std::vector<PreparedTree> prepared(trees.begin(), trees.end());
  PairFront front;
  Workspace workspace, fresh;
  int maybe = 0, certain = 0;
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 40 * orchard::test::more(); ++seed) {
    Journey journey(trees, seed + 7000);
    TreePair pair(prepared[journey.i], prepared[journey.j]);
    pair.use(&front);
    for (int step = 0; step < 100; ++step) {
      journey.step(step);
      const Pose at = centered(trees[journey.j], journey.b);
      Verdict verdict;
      const bool known = CoherentPair::recall(workspace, pair, journey.a, at, verdict);
      const Budget budget = {.work = step % 3 == 2 ? Budget{}.work : 1 + journey.draw.bits() % 400};
      if (!known) verdict = CoherentPair::search(workspace, pair, journey.a, at, budget);
      (verdict.answer == Answer::maybe ? maybe : certain) += 1;
      if (verdict.answer == Answer::maybe) {
        ASSERT_NE(step % 3, 2) << seed << " " << step;
        continue;
      }
      const Verdict truth = collide(fresh, TreePair(prepared[journey.i], prepared[journey.j]), journey.a, at);
      ASSERT_EQ(verdict.answer, truth.answer) << seed << " " << step;
    }
  }
  EXPECT_GT(maybe, 100);
  EXPECT_GT(certain, 1000);
}

TEST(PairFront, AllocatesNothingAndMayBeSharedByPairsOfOtherTrees) {
  const auto trees = meshes();
  std::vector<PreparedTree> prepared(trees.begin(), trees.end());
  PairFront front;
  Workspace workspace, fresh;
  std::vector<TreePair> pairs;
  for (std::size_t i = 0; i < prepared.size(); ++i) {
    pairs.emplace_back(prepared[i], prepared[(i + 1) % prepared.size()]).use(&front);
  }
  for (const TreePair& pair : pairs) collide(workspace, pair, {}, {}), collide(fresh, pair, {}, {});
  Journey journey(trees, 1);
  const std::size_t before = allocations;
  for (int step = 0; step < 300; ++step) {
    journey.step(step);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const std::size_t j = (i + 1) % pairs.size();
      const Pose a = centered(trees[i], {}), b = centered(trees[j], journey.b);
      const Answer answer = collide_coherently(workspace, pairs[i], a, b).answer;
      if (step % 10 == 0) {
        ASSERT_EQ(answer, collide(fresh, TreePair(prepared[i], prepared[j]), a, b).answer) << i << " " << step;
      }
    }
  }
  EXPECT_EQ(allocations, before);
}

// How far all of one are beyond all of the other one along a vector, over its length.
long double apart_along(const std::vector<Triangle>& p, const std::vector<Triangle>& q, const std::array<float, 3>& u) {
  const auto along = [&u](const auto& x) {
    return static_cast<long double>(x[0]) * u[0] + static_cast<long double>(x[1]) * u[1] +
           static_cast<long double>(x[2]) * u[2];
  };
  long double far = -1e300L, near = 1e300L;
  for (const Triangle& t : p) {
    for (const auto& x : t) far = std::max(far, along(x));
  }
  for (const Triangle& t : q) {
    for (const auto& x : t) near = std::min(near, along(x));
  }
  return (near - far) / std::sqrt(along(u));
}

TEST(FrontBlock, GivesTheSameBitsOnEveryMachineAndGapsThatAreThere) {
  const auto trees = meshes();
  int gaps = 0, leaves = 0;
  const std::uint64_t begin = orchard::test::first_seed();
  for (std::uint64_t seed = begin; seed < begin + 100 * orchard::test::more(); ++seed) {
    Draw draw(seed);
    const PackedSphereTree &a = trees[2 + draw.bits() % 4], &b = trees[9 + draw.bits() % 3];
    Pose pose = draw.pose(draw.uniform(0, 2.5));
    pose.scale = draw.uniform(0.5, 2);
    const detail::Placement placement = placement_of(pose, 12);
    const auto of_a = placed_triangles(a, {}), of_b = placed_triangles(b, pose);
    const auto block_a = static_cast<std::uint32_t>(draw.bits() % a.obb_nodes.size());
    const auto block_b = static_cast<std::uint32_t>(draw.bits() % b.obb_nodes.size());
    const detail::NodeBox own = detail::node_box_at(a.obb_nodes[block_a], 0),
                          other = detail::moved(detail::node_box_at(b.obb_nodes[block_b], 0), placement);
    // The first tree's node against the second one's eight, the other way round, and eight against eight.
    detail::BoxAxes axes[3]{}, plain[3]{};
    const float margin = placement.box_margin;
    const detail::NodeBox back = detail::moved_back(own, placement);
    detail::box_axes_scalar(back, b.obb_nodes[block_b], &placement, margin, plain[0]);
    detail::box_axes_scalar(other, a.obb_nodes[block_a], nullptr, margin, plain[1]);
    detail::box_pair_axes_scalar(a.obb_nodes[block_a], b.obb_nodes[block_b], placement, margin, plain[2]);
    const auto same = [](const detail::BoxAxes& p, const detail::BoxAxes& q) {
      return std::memcmp(&p.gap, &q.gap, sizeof p.gap) == 0 && std::memcmp(&p.ux, &q.ux, sizeof p.ux) == 0 &&
             std::memcmp(&p.uy, &q.uy, sizeof p.uy) == 0 && std::memcmp(&p.uz, &q.uz, sizeof p.uz) == 0 &&
             p.used == q.used && p.meeting == q.meeting;
    };
    on_every_machine([&] {
      detail::box_axes(back, b.obb_nodes[block_b], &placement, margin, axes[0]);
      detail::box_axes(other, a.obb_nodes[block_a], nullptr, margin, axes[1]);
      detail::box_pair_axes(a.obb_nodes[block_a], b.obb_nodes[block_b], placement, margin, axes[2]);
      for (int i = 0; i < 3; ++i) ASSERT_TRUE(same(axes[i], plain[i])) << seed << " " << i;
    });
    if (HasFatalFailure()) return;
    const auto check = [&](const detail::BoxAxes& found, std::uint32_t node_of_a, std::uint32_t node_of_b,
                           std::uint32_t lane, float sign) {
      if (a.obb_nodes[node_of_a / kBlockWidth].radius[node_of_a % kBlockWidth] < 0) return;
      if (b.obb_nodes[node_of_b / kBlockWidth].radius[node_of_b % kBlockWidth] < 0) return;
      const std::array<float, 3> u = {sign * found.ux[lane], sign * found.uy[lane], sign * found.uz[lane]};
      ASSERT_LE(found.gap[lane],
                apart_along(triangles_below(a, node_of_a, of_a), triangles_below(b, node_of_b, of_b), u))
          << seed;
      gaps += found.gap[lane] > 0;
    };
    for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
      check(plain[0], block_a * kBlockWidth, block_b * kBlockWidth + lane, lane, 1);
      check(plain[1], block_a * kBlockWidth + lane, block_b * kBlockWidth, lane, -1);
      check(plain[2], block_a * kBlockWidth + lane, block_b * kBlockWidth + lane, lane, 1);
    }
    const std::uint32_t node_a = block_a * kBlockWidth, node_b = block_b * kBlockWidth;
    const std::uint32_t leaf_a = a.obb_nodes[block_a].child[0], leaf_b = b.obb_nodes[block_b].child[0];
    if ((leaf_a & leaf_b & kLeafBit) == 0) continue;
    const detail::LeafPair pair = {a.triangle_blocks[leaf_a & ~kLeafBit], b.triangle_blocks[leaf_b & ~kLeafBit], own,
                                   other};
    const float enough = static_cast<float>(draw.uniform(0, 0.3));
    constexpr std::array<float, 3> given = {0, 0.6f, 0.8f};
    const std::array<float, 3>* const direction = draw.bits() % 2 == 0 ? &given : nullptr;
    const detail::LeafAxis leaf = detail::leaf_axis_scalar(pair, placement, direction, enough);
    on_every_machine([&] {
      const detail::LeafAxis again = detail::leaf_axis(pair, placement, direction, enough);
      ASSERT_EQ(again.gap, leaf.gap) << seed;
      ASSERT_EQ(again.u, leaf.u) << seed;
    });
    if (HasFatalFailure()) return;
    ASSERT_LE(leaf.gap, apart_along(triangles_below(a, node_a, of_a), triangles_below(b, node_b, of_b), leaf.u))
        << seed;
    leaves += leaf.gap > 0;
  }
  EXPECT_GT(gaps, 100);
  EXPECT_GT(leaves, 5);
}

TEST(FrontBlock, ClosesGapsByTheSameBitsOnEveryMachine) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Draw draw(seed);
    std::vector<detail::FrontBlock> blocks(1 + draw.bits() % 20);
    for (detail::FrontBlock& block : blocks) {
      for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
        const Vec u = draw.direction();
        const auto f = [&draw](double low, double high) { return static_cast<float>(draw.uniform(low, high)); };
        block.x[lane] = f(-2, 2), block.y[lane] = f(-2, 2), block.z[lane] = f(-2, 2), block.radius[lane] = f(0, 1);
        block.ux[lane] = static_cast<float>(u[0]), block.uy[lane] = static_cast<float>(u[1]);
        block.uz[lane] = static_cast<float>(u[2]);
        block.gap[lane] = lane == 3 ? std::numeric_limits<float>::infinity() : lane == 5 ? -1e30f : f(-0.1, 0.3);
        block.a[lane] = block.b[lane] = 0;
      }
    }
    detail::Shift shift{};
    for (float& x : shift.turn) x = static_cast<float>(draw.uniform(-0.05, 0.05));
    for (float& x : shift.by) x = static_cast<float>(draw.uniform(-0.05, 0.05));
    shift.swing = 0.06f, shift.error = 1e-6f;
    auto plain = blocks;
    std::vector<std::uint64_t> open((blocks.size() + 7) / 8), plain_open(open.size());
    const auto count = static_cast<std::uint32_t>(blocks.size());
    const float plain_least = detail::close_gaps_scalar(shift, plain.data(), count, plain_open.data());
    on_every_machine([&] {
      auto moved = blocks;
      ASSERT_EQ(detail::close_gaps(shift, moved.data(), count, open.data()), plain_least) << seed;
      ASSERT_EQ(open, plain_open) << seed;
      for (std::size_t i = 0; i < moved.size(); ++i) ASSERT_EQ(moved[i].gap, plain[i].gap) << seed;
    });
    if (HasFatalFailure()) return;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < plain.size(); ++i) {
      for (std::uint32_t lane = 0; lane < kBlockWidth; ++lane) {
        const bool apart = plain[i].gap[lane] > 0;
        ASSERT_EQ(plain_open[i / 8] >> (8 * (i % 8) + lane) & 1, apart ? 0u : 1u) << seed;
        if (apart) least = std::min(least, plain[i].gap[lane]);
      }
    }
    ASSERT_EQ(plain_least, least);
  }
}

}  // namespace
}  // namespace orchard::runtime
