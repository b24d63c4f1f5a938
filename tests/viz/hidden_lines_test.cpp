#include "hidden_lines.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "line_chains.h"
#include "orchard/geometry/random.h"

namespace orchard::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Parts = std::vector<std::pair<double, double>>;

bool contains(const Parts& parts, double t) {
  for (const auto& [begin, end] : parts)
    if (t >= begin && t <= end) return true;
  return false;
}

Vector3d random_place(Random& random) { return 10 * Vector3d(random.uniform(), random.uniform(), random.uniform()); }

// Whether a triangle is in front of a place, by solving for the place's weights.
bool covers(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& p, double slack) {
  Eigen::Matrix2d sides;
  sides << b.x() - a.x(), c.x() - a.x(), b.y() - a.y(), c.y() - a.y();
  const Vector2d weight = sides.inverse() * (p - a).head<2>();
  if (weight.minCoeff() < 0 || weight.sum() > 1) return false;
  return a.z() + weight[0] * (b.z() - a.z()) + weight[1] * (c.z() - a.z()) > p.z() + slack;
}

TEST(Occluders, HideWhatIsBehindTrianglesAndNothingElse) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 1, 1);
    constexpr double kSlack = 0.01;
    Occluders occluders(kSlack);
    std::vector<std::array<Vector3d, 3>> triangles;
    for (int i = 0; i < 40; ++i) {
      const Vector3d a = random_place(random), b = a + 0.3 * random_place(random), c = a + 0.3 * random_place(random);
      triangles.push_back({a, b, c});
      occluders.add_triangle(a, b, c);
    }
    occluders.finish();
    for (int line = 0; line < 20; ++line) {
      const Vector3d from = random_place(random), to = random_place(random);
      const Parts seen = occluders.visible(from, to);
      for (int i = 0; i < 50; ++i) {
        const double t = (i + 0.5) / 50;
        const Vector3d p = from + t * (to - from);
        bool hidden = false;
        for (const auto& [a, b, c] : triangles) hidden = hidden || covers(a, b, c, p, kSlack);
        EXPECT_EQ(contains(seen, t), !hidden) << "line " << line << " at " << t;
      }
    }
  }
}

TEST(Occluders, HideWhatIsBehindOrInsideSpheres) {
  Occluders occluders(0.001);
  occluders.add_sphere({0, 0, 0}, 1);
  occluders.finish();
  const auto ends = [&](const Vector3d& a, const Vector3d& b) { return occluders.visible(a, b); };
  EXPECT_EQ(ends({-2, 0, 2}, {2, 0, 2}), (Parts{{0, 1}})) << "in front";
  const Parts behind = ends({-2, 0, -2}, {2, 0, -2});
  ASSERT_EQ(behind.size(), 2u);
  EXPECT_NEAR(behind[0].second, 0.25, 0.002);
  EXPECT_NEAR(behind[1].first, 0.75, 0.002);
  const Parts through = ends({-2, 0, 0.5}, {2, 0, 0.5});
  ASSERT_EQ(through.size(), 2u) << "inside the sphere, where its front hides the line";
  EXPECT_NEAR(through[0].second, (2 - std::sqrt(0.75)) / 4, 0.002);
  // Its own outline.
  EXPECT_EQ(ends({1, 0, 0}, {std::cos(0.05), std::sin(0.05), 0}), (Parts{{0, 1}}));
}

TEST(Occluders, LeaveLinesThatLieOnTheirSurfaces) {
  Occluders occluders(0.001);
  occluders.add_triangle({0, 0, 0}, {4, 0, 1}, {0, 4, 2});
  occluders.finish();
  EXPECT_EQ(occluders.visible({0, 0, 0}, {4, 0, 1}), (Parts{{0, 1}}));
  EXPECT_EQ(occluders.visible({1, 1, 0.75}, {1, 1, 0.75}), (Parts{{0, 1}})) << "a dot";
  EXPECT_TRUE(occluders.visible({1, 1, 0.5}, {1, 1, 0.5}).empty());
}

TEST(LineChains, JoinWhatMeetsAndLeaveOutStraightPoints) {
  LineChains chains({Vector2d(0, 0), Vector2d(10, 10)});
  chains.add({0, 1}, {1, 1}, {2, 1}, 0, 1);
  chains.add({2, 1}, {3, 1}, {2, 1}, 0, 1);  // the other way round
  chains.add({2, 3}, {3, 1}, {3, 4}, 0, 1);
  const auto lines = chains.joined();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0], (std::vector<double>{1, 1, 3, 1, 3, 4}));
}

TEST(LineChains, EndAtTheSidesAtForksAndWhereTheyAreHidden) {
  LineChains chains({Vector2d(0, 0), Vector2d(10, 10)});
  chains.add({0, 1}, {-5, 5}, {5, 5}, 0, 1);
  chains.add({1, 2}, {5, 5}, {9, 5}, 0, 0.5);
  chains.add({1, 3}, {5, 5}, {5, 9}, 0, 1);
  const auto lines = chains.joined();
  ASSERT_EQ(lines.size(), 3u) << "three meet at a place";
  EXPECT_EQ(lines[0], (std::vector<double>{0, 5, 5, 5}));
  EXPECT_EQ(lines[1], (std::vector<double>{5, 5, 7, 5}));
}

TEST(LineChains, CloseLoops) {
  LineChains chains({Vector2d(0, 0), Vector2d(10, 10)});
  const std::vector<Vector2d> corners{{1, 1}, {5, 1}, {5, 5}, {1, 5}};
  for (int i = 0; i < 4; ++i)
    chains.add({i, (i + 1) % 4}, corners[static_cast<std::size_t>(i)], corners[static_cast<std::size_t>((i + 1) % 4)],
               0, 1);
  const auto lines = chains.joined();
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_EQ(lines[0].size(), 10u) << "the first corner comes again at the end";
  EXPECT_EQ(lines[0][0], lines[0][8]);
}

}  // namespace
}  // namespace orchard::detail
