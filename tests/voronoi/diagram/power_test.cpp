#include "orchard/voronoi/power.h"

#include <gtest/gtest.h>

#include "orchard/geometry/random.h"

namespace orchard {
namespace {

std::vector<Sphere> random_balls(Index count, std::uint64_t seed) {
  Random random(seed, 0);
  std::vector<Sphere> balls;
  for (Index i = 0; i < count; ++i) {
    const Point center(random.uniform(), random.uniform(), random.uniform());
    balls.push_back({center, random.uniform(0, 0.3)});
  }
  return balls;
}

double power(const Sphere& ball, const Point& place) {
  return (place - ball.center).squaredNorm() - ball.radius * ball.radius;
}

Index ball_of_least_power(const std::vector<Sphere>& balls, const Point& place) {
  Index best = 0;
  for (Index i = 1; i < balls.size(); ++i) {
    if (power(balls[i], place) < power(balls[best], place)) best = i;
  }
  return best;
}

TEST(PowerDiagram, VerticesAreAsFarFromTheirBallsAndNoBallIsNearer) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const std::vector<Sphere> balls = random_balls(40, seed);
    const PowerDiagram diagram = power_diagram(balls, Box(Point::Zero(), Point::Ones()));
    ASSERT_FALSE(diagram.vertices.empty());
    for (const PowerDiagram::Vertex& vertex : diagram.vertices) {
      const double own = power(balls[vertex.balls[0]], vertex.position);
      const double rounding = 1e-9 * (1 + vertex.position.squaredNorm());
      for (const Index i : vertex.balls) EXPECT_NEAR(power(balls[i], vertex.position), own, rounding);
      for (const Sphere& ball : balls) EXPECT_GE(power(ball, vertex.position), own - rounding);
    }
  }
}

TEST(PowerDiagram, SaysWhichCentersAreInTheirOwnCell) {
  const std::vector<Sphere> balls = random_balls(200, 4);
  const PowerDiagram diagram = power_diagram(balls, Box(Point::Zero(), Point::Ones()));
  Index others = 0;
  for (Index i = 0; i < balls.size(); ++i) {
    const bool own = ball_of_least_power(balls, balls[i].center) == i;
    EXPECT_EQ(diagram.holds_center[i] != 0, own) << i;
    others += own ? 0 : 1;
  }
  EXPECT_GT(others, 20u);
}

TEST(PowerDiagram, OfOneBallOrTwoThatAreTheSameHasNoVertex) {
  const Sphere ball{Point(0.5, 0.5, 0.5), 0.2};
  EXPECT_TRUE(power_diagram(std::vector{ball}, Box(Point::Zero(), Point::Ones())).vertices.empty());
  const PowerDiagram twice = power_diagram(std::vector{ball, ball}, Box(Point::Zero(), Point::Ones()));
  EXPECT_TRUE(twice.vertices.empty());
  EXPECT_EQ(twice.holds_center[0] + twice.holds_center[1], 1);
}

}  // namespace
}  // namespace orchard
