#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bodies.h"
#include "orchard/runtime/contacts.h"
#include "support/effort.h"

// Normals and depths of contacts() against the least way out along each of 2,000 directions, the best twenty refined,
// at shallow poses. Judged by whole queries of yes and no.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

double inner(const Vec& p, const Vec& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

Vec unit_of(Vec v) {
  const double size = std::sqrt(inner(v, v));
  for (double& x : v) x /= size;
  return v;
}

struct WayOut {
  double depth;
  Vec direction;
};

// The second body at `b` is moved.
class LeastWayOut {
 public:
  LeastWayOut(const TreePair& pair, const Pose& a, const Pose& b) : pair_(pair), a_(a), b_(b) {}

  // Up to `most`, where the surfaces first come apart along a direction: the first of 24 places, then bisected.
  double along(const Vec& u, double most) {
    constexpr int kPlaces = 24;
    for (int i = 1; i <= kPlaces; ++i) {
      if (touch(u, most * i / kPlaces)) continue;
      double low = most * (i - 1) / kPlaces, high = most * i / kPlaces;
      for (int k = 0; k < 20; ++k) (touch(u, (low + high) / 2) ? low : high) = (low + high) / 2;
      return high;
    }
    return std::numeric_limits<double>::infinity();
  }

  // All that are within 1.2 of the least, which is the first.
  std::vector<WayOut> find(Draw& draw, double most) {
    std::vector<WayOut> ways;
    double limit = most;
    for (int i = 0; i < 2000; ++i) {
      const Vec u = draw.direction();
      const double depth = along(u, limit);
      if (!std::isfinite(depth)) continue;
      ways.push_back({depth, u});
      limit = std::min(limit, 1.3 * depth);
    }
    const auto less = [](const WayOut& p, const WayOut& q) { return p.depth < q.depth; };
    std::sort(ways.begin(), ways.end(), less);
    for (std::size_t i = 0; i < std::min<std::size_t>(20, ways.size()); ++i) {
      double spread = 0.06;
      for (int k = 0; k < 60; ++k) {
        Vec u = ways[i].direction;
        const Vec off = draw.direction();
        for (std::size_t d = 0; d < 3; ++d) u[d] += spread * off[d];
        u = unit_of(u);
        const double depth = along(u, ways[i].depth);
        if (depth < ways[i].depth) {
          ways[i] = {depth, u};
        } else {
          spread *= 0.93;
        }
      }
    }
    std::sort(ways.begin(), ways.end(), less);
    std::erase_if(ways, [&](const WayOut& way) { return way.depth > 1.2 * ways[0].depth; });
    return ways;
  }

 private:
  bool touch(const Vec& u, double by) {
    Pose b = b_;
    for (std::size_t i = 0; i < 3; ++i) b.translation[i] += by * u[i];
    return collide(workspace_, pair_, a_, b).answer != Answer::no;
  }

  Workspace workspace_;
  TreePair pair_;
  Pose a_, b_;
};

double degrees(const Vec& p, const Vec& q) {
  return std::acos(std::clamp(inner(p, q), -1.0, 1.0)) * 180 / std::numbers::pi;
}

TEST(ContactAccuracy, ComesCloseToTheLeastWayOutOfManyDirections) {
  const auto all = bodies();
  std::vector<PreparedTree> trees;
  for (const Body& body : all) trees.emplace_back(body.tree);
  Workspace workspace;
  // 500 of them take minutes.
  const int wanted = orchard::test::more() > 1 ? 500 : 10;
  int shallow = 0, unique = 0, normals = 0, depths = 0;
  double worst_depth = 0;
  for (std::uint64_t seed = orchard::test::first_seed() + 500'000; shallow < wanted; ++seed) {
    Draw draw(seed);
    const std::size_t i = draw.bits() % 7, j = draw.bits() % 7;  // the closed ones
    const Vec way = draw.direction();
    const Pose a = centered(all[i].tree, draw.pose(0)), turned = draw.pose(0);
    const double reach = all[i].tree.bounding_radius + all[j].tree.bounding_radius;
    const TreePair pair(trees[i], trees[j]);
    const auto at = [&](double d) {
      Pose pose = centered(all[j].tree, turned);
      for (std::size_t k = 0; k < 3; ++k) pose.translation[k] += d * way[k];
      return pose;
    };
    double far = reach;
    while (far > 0 && collide(workspace, pair, a, at(far)).answer != Answer::yes) far -= 0.004 * reach;
    if (far <= 0) continue;
    const Manifold m = contacts(workspace, pair, a, at(far));
    ASSERT_EQ(m.answer, Answer::yes) << seed;
    if (m.depth < 1e-7 * reach) continue;  // too shallow for the judge
    ++shallow;
    LeastWayOut judge(pair, a, at(far));
    const std::vector<WayOut> ways = judge.find(draw, 1.5 * m.depth);
    if (ways.empty()) {  // nothing of the judge's is as good
      ++depths;
      continue;
    }
    const double ratio = m.depth / ways[0].depth;
    worst_depth = std::max(worst_depth, ratio);
    depths += ratio <= 1.05;
    const bool one = std::all_of(ways.begin(), ways.end(),
                                 [&](const WayOut& w) { return degrees(w.direction, ways[0].direction) < 40; });
    if (!one) continue;
    ++unique;
    normals += degrees(m.normal, ways[0].direction) <= 10;
  }
  std::printf("%d poses; depth within 5 %%: %d, worst %.2f times; unique: %d, normal within 10 degrees: %d\n", shallow,
              depths, worst_depth, unique, normals);
  EXPECT_GE(20 * depths, 19 * shallow);
  EXPECT_GE(20 * normals, 19 * unique);
}

}  // namespace
}  // namespace orchard::runtime
