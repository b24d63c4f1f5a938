#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "least_way_out.h"
#include "orchard/runtime/contacts.h"
#include "support/effort.h"

// Normals and depths of contacts() against the least way out along each of 2,000 directions, at shallow poses.
namespace orchard::runtime {
namespace {

using namespace orchard::runtime::test;

TEST(ContactAccuracy, ComesCloseToTheLeastWayOutOfManyDirections) {
  const auto all = bodies();
  std::vector<PreparedTree> trees;
  trees.reserve(all.size());
  for (const Body& body : all) trees.emplace_back(body.tree);
  Workspace workspace;
  // 500 of them take minutes.
  const int wanted = orchard::test::more() > 1 ? 500 : 10;
  int shallow = 0, unique = 0, normals = 0, depths = 0;
  double worst_depth = 0;
  for (std::uint64_t seed = orchard::test::first_seed() + 500'000; shallow < wanted; ++seed) {
    Draw draw(seed);
    const auto pose = shallow_pose(draw, all, trees, workspace);
    if (!pose) continue;
    const TreePair pair(trees[pose->i], trees[pose->j]);
    const Manifold m = contacts(workspace, pair, pose->a, pose->b);
    ASSERT_EQ(m.answer, Answer::yes) << seed;
    if (m.depth < 1e-7 * pose->reach) continue;  // too shallow for the judge
    ++shallow;
    LeastWayOut judge(pair, pose->a, pose->b);
    const std::vector<MinimumTranslation> ways = judge.find(draw, 1.5 * m.depth);
    if (ways.empty()) {  // nothing of the judge's is as good
      ++depths;
      continue;
    }
    const double ratio = m.depth / ways[0].depth;
    worst_depth = std::max(worst_depth, ratio);
    depths += ratio <= 1.05;
    if (!is_unique(ways)) continue;
    ++unique;
    normals += degrees_between(m.normal, ways[0].direction) <= 10;
  }
  std::printf("%d poses; depth within 5 %%: %d, worst %.2f times; unique: %d, normal within 10 degrees: %d\n", shallow,
              depths, worst_depth, unique, normals);
  EXPECT_GE(20 * depths, 19 * shallow);
  EXPECT_GE(20 * normals, 19 * unique);
}

}  // namespace
}  // namespace orchard::runtime
