#pragma once
#include <gtest/gtest.h>

#include <array>
#include <initializer_list>
#include <span>
#include <vector>

#include "orchard/covering/boundary_lemma.h"
#include "orchard/geometry/random.h"
#include "support/path_rule.h"

namespace orchard::test {

using Triangle = std::array<Point, 3>;

inline Vector random_vector(Random& random, double size = 1) {
  return size * Vector(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
}

inline Triangle random_triangle(Random& random) {
  return {random_vector(random), random_vector(random), random_vector(random)};
}

inline Point point_of(const Triangle& t, double u, double v) {
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
}

inline std::vector<PathBall> leaves(std::initializer_list<Sphere> spheres) {
  std::vector<PathBall> balls;
  for (const Sphere& s : spheres) balls.push_back({s.center, s.radius, kNone, true});
  return balls;
}

inline std::vector<PathBall> grown(std::vector<PathBall> balls, double by) {
  for (PathBall& ball : balls) ball.radius += by;
  return balls;
}

// Balls of random sizes around points near the triangle, as a forest of random distance.
inline std::vector<PathBall> random_forest(Random& random, const Triangle& t, double scale) {
  const auto count = static_cast<Index>(4 + random.below(40));
  std::vector<PathBall> balls;
  std::vector<char> has_child(count, 0);
  for (Index i = 0; i < count; ++i) {
    PathBall ball{point_of(t, random.uniform(), random.uniform()) + random_vector(random, 0.2 * scale),
                  scale * random.uniform(0.2, 0.9), kNone, true};
    if (i > 0 && random.below(3) > 0) {
      ball.parent = static_cast<Index>(random.below(i));
      has_child[ball.parent] = 1;
    }
    balls.push_back(ball);
  }
  for (Index i = 0; i < count; ++i) balls[i].leaf = !has_child[i];
  return balls;
}

}  // namespace orchard::test
